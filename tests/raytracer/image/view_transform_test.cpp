// View transforms: standard and AgX.
#include "raytracer/image/view_transform.hpp"

#include "catch.hpp"

using namespace deburr;

TEST_CASE("The standard view is the light itself, and AgX keeps greys grey, grows, and ends at white") {
    CHECK(displayed(ViewTransform::standard, {0.2, 3, 0}) == Vec3(0.2, 3, 0));
    double last = -1;
    for (double stops = -12; stops <= 6; stops += 0.25) {
        const Vec3 v = displayed(ViewTransform::agx, Vec3(std::exp2(stops)));
        CHECK(v.x == Approx(v.y).margin(1e-3));
        CHECK(v.x == Approx(v.z).margin(1e-3));
        CHECK(v.x >= last - 1e-3);
        CHECK(v.x <= 1);
        last = v.x;
    }
    CHECK(last > 0.95);
    // Middle grey stays nearly the same; bright red light becomes whitish and is not clipped to pure red.
    CHECK(displayed(ViewTransform::agx, Vec3(0.18)).x == Approx(0.18).margin(0.04));
    const Vec3 red = displayed(ViewTransform::agx, {40, 0.4, 0.4});
    CHECK(red.x > red.y);
    CHECK(red.y > 0.3);
    CHECK(displayed(ViewTransform::agx, Vec3(0.0)).x < 0.001);
}

TEST_CASE("Colours that alpha has weighed are shown as what they are") {
    Film film(2, 1, {0, 0, 2, 1});
    film.pixels[0] = {Vec3(0.25), 0.5};
    film.pixels[1] = {Vec3(0.0), 0};
    const Film shown = displayed(ViewTransform::agx, film, true);
    CHECK(shown.pixels[0].color.x == Approx(0.5 * displayed(ViewTransform::agx, Vec3(0.5)).x));
    CHECK(shown.pixels[1].color == Vec3(0.0));
}
