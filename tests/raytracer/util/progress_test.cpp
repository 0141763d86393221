// Progress on a terminal, as lines, as JSON and for render farms.
#include "raytracer/util/progress.hpp"

#include "catch.hpp"

using namespace deburr;

namespace {

// Records what a Progress prints; the test sets its clock.
struct Screen {
    double now = 100;
    std::vector<std::string> printed;

    Progress::Output output(Progress::Style style) {
        Progress::Output output;
        output.style = style;
        output.columns = 60;
        output.print = [this](std::string_view text) { printed.emplace_back(text); };
        output.now = [this] { return now; };
        return output;
    }
};

int percent_of(const std::string& text) {
    const std::size_t at = text.find(" %");
    return at == std::string::npos || at < 3 ? -1 : std::stoi(text.substr(at - 3, 3));
}

}  // namespace

TEST_CASE("the bar is monotone, fits the terminal and reaches 100 % only at the end") {
    Screen screen;
    Progress progress(1000, screen.output(Progress::Style::bar));
    for (int i = 0; i < 1000; ++i) {
        screen.now += 0.05;
        progress.advance(1);
    }
    int before = 0;
    for (const std::string& text : screen.printed) {
        CHECK(text.front() == '\r');
        CHECK(text.size() - 1 < 60);
        CHECK(percent_of(text) >= before);
        before = percent_of(text);
    }
    CHECK(screen.printed.size() > 400);  // ten per second
    CHECK(screen.printed.size() < 510);
    CHECK(before == 99);
    progress.finish();
    REQUIRE(screen.printed.size() > 2);
    CHECK(percent_of(screen.printed[screen.printed.size() - 2]) == 100);
    CHECK(screen.printed.back() == "\n");
}

TEST_CASE("time left supposes that the rest goes as fast") {
    Screen screen;
    Progress progress(4, screen.output(Progress::Style::bar));
    screen.now += 25;
    progress.advance(1);
    REQUIRE(screen.printed.size() == 1);
    CHECK(screen.printed[0].find(" 25 %  1:15 left") != std::string::npos);
}

TEST_CASE("without a terminal a line every 10 % or 10 s, and none at once") {
    Screen screen;
    Progress progress(1000, screen.output(Progress::Style::lines));
    progress.advance(150);
    CHECK(screen.printed.empty());
    screen.now += 2;
    progress.advance(60);  // 21 %
    CHECK(screen.printed.size() == 1);
    screen.now += 2;
    progress.advance(60);  // 27 %
    CHECK(screen.printed.size() == 1);
    screen.now += 10;
    progress.advance(10);
    CHECK(screen.printed.size() == 2);
    progress.finish();
    REQUIRE(screen.printed.size() == 3);
    CHECK(screen.printed.back() == "100 %  in 14.0 s\n");
    for (const std::string& line : screen.printed) CHECK(line.back() == '\n');
}

TEST_CASE("a quiet progress prints nothing") {
    Screen screen;
    Progress progress(10, screen.output(Progress::Style::none));
    screen.now += 20;
    progress.advance(5);
    progress.stop();
    progress.finish();
    CHECK(screen.printed.empty());
}

TEST_CASE("clock_time rounds up to seconds") {
    CHECK(clock_time(0) == "0:00");
    CHECK(clock_time(0.2) == "0:01");
    CHECK(clock_time(75) == "1:15");
    CHECK(clock_time(3675) == "1:01:15");
}

TEST_CASE("what an earlier run has done does not count for the time that is left") {
    Screen screen;
    Progress progress(8, screen.output(Progress::Style::bar), 4);
    screen.now += 25;
    progress.advance(1);
    REQUIRE(screen.printed.size() == 1);
    CHECK(screen.printed[0].find(" 62 %  1:15 left") != std::string::npos);
}

TEST_CASE("progress for render farms is a line at every percent") {
    Screen screen;
    Progress progress(200, screen.output(Progress::Style::farm));
    for (int i = 0; i < 200; ++i) {
        screen.now += 1;
        progress.advance(1);
    }
    progress.finish();
    REQUIRE(screen.printed.size() == 100);  // 1 to 99 %, and the end
    CHECK(screen.printed[0] == "Progress: 1%  3:18 left\n");
    CHECK(screen.printed.back() == "Progress: 100%  in 3:20\n");
}

TEST_CASE("progress as JSON is an object a line, once a second, and one that says how it ended") {
    for (const bool done : {true, false}) {
        Screen screen;
        Progress progress(100, screen.output(Progress::Style::json));
        for (int i = 0; i < 50; ++i) {
            screen.now += 0.25;
            progress.advance(2);
        }
        done ? progress.finish() : progress.stop();
        if (done) progress.stop();
        REQUIRE(screen.printed.size() == 13);
        CHECK(screen.printed[0] ==
              "{\"event\": \"progress\", \"fraction\": 0.0800, \"seconds\": 1.0, \"seconds_left\": 11.5}\n");
        CHECK(screen.printed.back().find(done ? "{\"event\": \"done\", \"fraction\": 1.0000"
                                              : "{\"event\": \"stopped\"") == 0);
    }
}
