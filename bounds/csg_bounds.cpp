#include "bounds/csg_bounds.hpp"

#include "bounds/box_range.hpp"

namespace deburr {
namespace {

// The bound that a node's operands have to supply: outer or inner, at threshold t.
struct Demand {
    bool outer = true;
    double t = 0;
};

// The demands on all nodes by the theorems, from the root down.
std::vector<Demand> demands(const DensityTree& tree, Demand root) {
    std::vector<Demand> all(tree.nodes.size());
    all.back() = root;
    for (int i = tree.root(); i >= 0; --i) {
        const TreeNode& n = tree.nodes[i];
        const auto [outer, t] = all[i];
        const auto ask = [&](Demand a, Demand b) {
            all[n.a] = a;
            if (n.b >= 0) all[n.b] = b;
        };
        switch (n.op) {
            case Op::product:  // theorems 1 and 5
                outer ? ask({true, t}, {true, t}) : ask({false, std::sqrt(t)}, {false, std::sqrt(t)});
                break;
            case Op::conjunction:
                outer ? ask({true, t}, {true, t}) : ask({false, (1 + t) / 2}, {false, (1 + t) / 2});
                break;
            case Op::sum:  // theorems 2 and 4
            case Op::disjunction: outer ? ask({true, t / 2}, {true, t / 2}) : ask({false, t}, {false, t}); break;
            case Op::difference:  // theorems 3 and 6
                outer ? ask({true, t}, {false, 1 - t}) : ask({false, t}, {true, 0});
                break;
            case Op::complement: ask({!outer, 1 - t}, {}); break;
            case Op::convolution: ask({outer, t}, {}); break;
            default: break;
        }
    }
    return all;
}

class BoundBuilder {
public:
    explicit BoundBuilder(double clearance) : clear_(clearance) {}

    BoundCsg run(const DensityTree& tree, Demand root) {
        const std::vector<Demand> asked = demands(tree, root);
        std::vector<int> new_index(tree.nodes.size());
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const TreeNode& n = tree.nodes[i];
            const auto at = [&](int child) { return new_index[child]; };
            const auto [outer, t] = asked[i];
            switch (n.op) {
                case Op::constant: new_index[i] = constant(outer ? n.value > t : n.value >= t); break;
                case Op::half_space: new_index[i] = plane(tree.half_spaces[n.a], asked[i]); break;
                case Op::product:
                case Op::conjunction: new_index[i] = intersect(at(n.a), at(n.b)); break;
                case Op::sum:
                case Op::disjunction: new_index[i] = unite(at(n.a), at(n.b)); break;
                case Op::difference: new_index[i] = intersect(at(n.a), complement(at(n.b))); break;
                case Op::complement: new_index[i] = complement(at(n.a)); break;
                case Op::convolution: new_index[i] = again(at(n.a)); break;
            }
        }
        csg_.nodes.resize(std::size_t(new_index.back()) + 1);
        csg_.convex = true;
        for (const BoundCsg::Node& n : csg_.nodes)
            csg_.convex &= n.kind == BoundCsg::Kind::plane || n.kind == BoundCsg::Kind::intersect;
        return std::move(csg_);
    }

private:
    int add(BoundCsg::Node node) {
        csg_.nodes.push_back(node);
        return int(csg_.nodes.size()) - 1;
    }
    BoundCsg::Kind kind(int i) const { return csg_.nodes[i].kind; }
    int constant(bool everything) { return add({everything ? BoundCsg::Kind::everything : BoundCsg::Kind::nothing}); }

    int plane(const HalfSpace& h, Demand asked) {
        const auto [outer, t] = asked;
        if (outer ? t < 0 : t <= 0) return constant(true);
        if (outer ? t >= 1 : t > 1) return constant(false);
        // Besides the cubic's slack in ρ, the plane is displaced by the rounding error of its distance.
        const double clearance = clear_ + 4 * epsilon * (std::abs(h.offset) + h.radius);
        double offset = h.offset + (outer ? clearance : -clearance);
        if (h.radius > 0) offset += h.radius * displacement(outer ? t - inverse_slack : t + inverse_slack);
        csg_.planes.push_back({h.normal, offset});
        return add({BoundCsg::Kind::plane, int(csg_.planes.size()) - 1});
    }

    int intersect(int a, int b) {
        if (kind(a) == BoundCsg::Kind::nothing || kind(b) == BoundCsg::Kind::nothing) return constant(false);
        if (kind(a) == BoundCsg::Kind::everything) return again(b);
        if (kind(b) == BoundCsg::Kind::everything) return again(a);
        return add({BoundCsg::Kind::intersect, a, b});
    }
    int unite(int a, int b) {
        if (kind(a) == BoundCsg::Kind::everything || kind(b) == BoundCsg::Kind::everything) return constant(true);
        if (kind(a) == BoundCsg::Kind::nothing) return again(b);
        if (kind(b) == BoundCsg::Kind::nothing) return again(a);
        return add({BoundCsg::Kind::unite, a, b});
    }
    int complement(int a) {
        if (kind(a) == BoundCsg::Kind::nothing || kind(a) == BoundCsg::Kind::everything)
            return constant(kind(a) == BoundCsg::Kind::nothing);
        return add({BoundCsg::Kind::complement, a});
    }
    // Node i, copied to the end if it is not the last node, because the root must come last.
    int again(int i) { return i + 1 == int(csg_.nodes.size()) ? i : add(csg_.nodes[i]); }

    double clear_;
    BoundCsg csg_;
};

}  // namespace

bool BoundCsg::contains(Vec3 x) const {
    std::vector<char> in;
    for (const Node& n : nodes) {
        const auto at = [&](int child) -> bool { return in[child]; };
        switch (n.kind) {
            case BoundCsg::Kind::nothing: in.push_back(false); break;
            case BoundCsg::Kind::everything: in.push_back(true); break;
            case BoundCsg::Kind::plane: {
                const BoundPlane& p = planes[n.a];
                in.push_back(glm::dot(p.normal, x) <= p.offset);
                break;
            }
            case BoundCsg::Kind::intersect: in.push_back(at(n.a) && at(n.b)); break;
            case BoundCsg::Kind::unite: in.push_back(at(n.a) || at(n.b)); break;
            case BoundCsg::Kind::complement: in.push_back(!at(n.a)); break;
        }
    }
    return in.back();
}

BoundCsg outer_bound(const DensityTree& tree, double t, double clearance) {
    return BoundBuilder(clearance).run(tree, {true, t});
}
BoundCsg inner_bound(const DensityTree& tree, double t, double clearance) {
    return BoundBuilder(clearance).run(tree, {false, t});
}

// ---- on a ray ------------------------------------------------------------------------------------

namespace {

constexpr Span no_span{infinity, -infinity};

Span ray_in_plane(const BoundPlane& plane, Vec3 origin, Vec3 direction) {
    const double rate = glm::dot(plane.normal, direction);
    const double room = plane.offset - glm::dot(plane.normal, origin);  // inside where rate·t ≤ room
    if (rate > 0) return {-infinity, room / rate};
    if (rate < 0) return {room / rate, infinity};
    return room >= 0 ? Span{-infinity, infinity} : no_span;
}

Span intersection(Span a, Span b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }

Span convex_span(const BoundCsg& csg, Vec3 origin, Vec3 direction) {
    Span all{-infinity, infinity};
    for (const BoundPlane& plane : csg.planes) {
        all = intersection(all, ray_in_plane(plane, origin, direction));
        if (all.lo > all.hi) return no_span;
    }
    return all;
}

}  // namespace

// The spans of every node along the ray, sorted and disjoint, all in one pool.
void SearchSpans::general(const BoundCsg& csg, Vec3 origin, Vec3 direction) {
    pool_.clear();
    parts_.clear();
    for (const BoundCsg::Node& n : csg.nodes) {
        Part part{pool_.size(), 0};
        const auto a = [&] { return parts_[n.a]; };
        const auto b = [&] { return parts_[n.b]; };
        switch (n.kind) {
            case BoundCsg::Kind::nothing: break;
            case BoundCsg::Kind::everything: pool_.push_back({-infinity, infinity}); break;
            case BoundCsg::Kind::plane: {
                const Span s = ray_in_plane(csg.planes[n.a], origin, direction);
                if (s.lo <= s.hi) pool_.push_back(s);
                break;
            }
            case BoundCsg::Kind::intersect:
                for (std::size_t i = 0, j = 0; i < a().count && j < b().count;) {
                    const Span x = pool_[a().first + i], y = pool_[b().first + j];
                    const Span s = intersection(x, y);
                    if (s.lo <= s.hi) pool_.push_back(s);
                    x.hi < y.hi ? ++i : ++j;
                }
                break;
            case BoundCsg::Kind::unite:
                for (std::size_t i = 0, j = 0; i < a().count || j < b().count;) {
                    const bool from_a =
                        j >= b().count || (i < a().count && pool_[a().first + i].lo <= pool_[b().first + j].lo);
                    const Span s = from_a ? pool_[a().first + i++] : pool_[b().first + j++];
                    if (pool_.size() > part.first && s.lo <= pool_.back().hi)
                        pool_.back().hi = std::max(pool_.back().hi, s.hi);
                    else
                        pool_.push_back(s);
                }
                break;
            case BoundCsg::Kind::complement: {
                double from = -infinity;
                for (std::size_t i = 0; i < a().count; ++i) {
                    const Span s = pool_[a().first + i];
                    if (s.lo > from) pool_.push_back({from, s.lo});
                    from = s.hi;
                }
                if (from < infinity) pool_.push_back({from, infinity});
                break;
            }
        }
        part.count = pool_.size() - part.first;
        parts_.push_back(part);
    }
}

const std::vector<Span>& SearchSpans::between(const BoundCsg& outer, const BoundCsg& inner, Vec3 origin, Vec3 direction,
                                              double t0, double t1) {
    result_.clear();
    const auto add = [&](double lo, double hi) {
        lo = std::max(lo, t0);
        hi = std::min(hi, t1);
        if (lo > hi) return;
        if (!result_.empty() && lo <= result_.back().hi)
            result_.back().hi = std::max(result_.back().hi, hi);
        else
            result_.push_back({lo, hi});
    };
    if (outer.convex && inner.convex) {
        const Span o = convex_span(outer, origin, direction);
        if (o.lo > o.hi || o.lo > t1 || o.hi < t0) return result_;
        const Span i = convex_span(inner, origin, direction);
        if (i.lo >= i.hi) {
            add(o.lo, o.hi);
        } else {
            if (i.lo > o.lo) add(o.lo, i.lo);
            if (i.hi < o.hi) add(i.hi, o.hi);
        }
        return result_;
    }
    general(inner, origin, direction);
    const Part in = parts_.back();
    inside_.assign(pool_.begin() + std::ptrdiff_t(in.first), pool_.begin() + std::ptrdiff_t(in.first + in.count));
    general(outer, origin, direction);
    const Part out = parts_.back();
    std::size_t next = 0;
    for (std::size_t k = 0; k < out.count; ++k) {
        const Span o = pool_[out.first + k];
        double from = o.lo;
        while (next < inside_.size() && inside_[next].hi < o.lo) ++next;
        for (std::size_t j = next; j < inside_.size() && inside_[j].lo < o.hi; ++j) {
            const auto [lo, hi] = inside_[j];
            if (lo > from) add(from, lo);
            from = std::max(from, hi);
        }
        if (from < o.hi) add(from, o.hi);
    }
    return result_;
}

}  // namespace deburr
