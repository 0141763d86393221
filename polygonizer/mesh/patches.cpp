#include "polygonizer/mesh/patches.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

namespace deburr {
namespace {

std::vector<int> all_numbers(std::size_t count) {
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    return all;
}

// The number before; −1 for elements that were added since.
int number_of(const std::vector<int>& numbers, int index) {
    return std::size_t(index) < numbers.size() ? numbers[index] : -1;
}

/// Composes two renumberings: result[k] = numbers[of[k]].
std::vector<int> composed(const std::vector<int>& numbers, const std::vector<int>& of) {
    std::vector<int> result;
    result.reserve(of.size());
    for (const int index : of) result.push_back(number_of(numbers, index));
    return result;
}

// A key of the facet's bits, cell, leaf and material.
FacetKey source_key(const Mesh& mesh, const Triangle& triangle, Origin origin) {
    FacetKey key = facet_key(mesh, triangle, origin);
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
    key.a ^= golden * (std::uint64_t(std::uint32_t(origin.cell)) << 32 | std::uint32_t(triangle.material));
    return key;
}

}  // namespace

Patches::Patches(const Mesh& mesh, const std::vector<Origin>& origins)
    : joined_(mesh.triangles.size()),
      source_(all_numbers(mesh.triangles.size())),
      vertices_(all_numbers(mesh.positions.size())),
      normals_(all_numbers(mesh.normals.size())) {
    sources_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < origins.size(); ++t) {
        const Triangle& triangle = mesh.triangles[t];
        sources_.push_back({source_key(mesh, triangle, origins[t]), triangle.vertex, triangle.normal});
    }
}

void Patches::join(std::span<const int> facets) {
    for (const int f : facets) joined_.join(source_[facets[0]], source_[f]);
}

void Patches::change(const Change& change, const std::vector<int>& fresh) {
    join(change.out);
    const int source = source_[change.out[0]];
    for (const int f : fresh) {
        if (std::size_t(f) >= source_.size()) source_.resize(std::size_t(f) + 1);
        source_[f] = source;
    }
}

void Patches::renumber(const std::vector<int>& facets, const std::vector<int>& vertices,
                       const std::vector<int>& normals) {
    source_ = composed(source_, facets);
    vertices_ = composed(vertices_, vertices);
    normals_ = composed(normals_, normals);
}

// One run of put_into(). A patch is identified by the source that represents it in joined_.
class Patches::Insertion {
public:
    Insertion(const Patches& patches, Mesh& fresh, std::vector<Origin>& fresh_origins, const Mesh& mesh,
              const std::vector<Origin>& origins)
        : patches_(patches),
          fresh_(fresh),
          fresh_origins_(fresh_origins),
          mesh_(mesh),
          origins_(origins),
          joined_(patches.joined_),
          is_kept_(patches.sources_.size(), true) {}

    Patches run(std::span<const int> but) {
        for (const int t : but) forget(patches_.source_[t]);
        find_sources();
        match_corners();
        while (true) {
            std::vector<Piece> pieces = assemble();
            if (!drop_double_edges(pieces)) return insert(pieces);
        }
    }

private:
    // A triangle of the result.
    struct Piece {
        int facet;      // of the fresh mesh: this facet, or the first facet of the patch
        int kept = -1;  // triangle of the old mesh; −1: the fresh facet stays
    };

    int patch_of(int source) { return joined_.find(source); }
    void forget(int source) { is_kept_[patch_of(source)] = false; }

    // Finds the source that each fresh facet is. Facets with equal keys are no one's source.
    void find_sources() {
        const auto count = patches_.sources_.size();
        std::vector<int> table(std::bit_ceil(2 * count + 1), -1);
        const auto place = [&](const FacetKey& key) {
            std::size_t at = key.hash() & (table.size() - 1);
            while (table[at] >= 0 && patches_.sources_[table[at]].key != key) at = (at + 1) & (table.size() - 1);
            return at;
        };
        std::vector<char> is_found(count, false);
        for (std::size_t s = 0; s < count; ++s) {
            int& known = table[place(patches_.sources_[s].key)];
            if (known < 0) {
                known = int(s);
                continue;
            }
            forget(known);
            forget(int(s));
        }
        source_.assign(fresh_.triangles.size(), -1);
        for (std::size_t f = 0; f < source_.size(); ++f) {
            const int s = table[place(source_key(fresh_, fresh_.triangles[f], fresh_origins_[f]))];
            if (s < 0) continue;
            if (is_found[s]) {
                forget(s);
                continue;
            }
            is_found[s] = true;
            source_[f] = s;
        }
        for (std::size_t s = 0; s < count; ++s)
            if (!is_found[s]) forget(int(s));
    }

    // Finds the vertex and normal of the fresh mesh that each old one is. Where vertices in one place were
    // distinguished differently, their patches are not kept.
    void match_corners() {
        std::vector<int> before(fresh_.positions.size(), -1);
        for (std::size_t f = 0; f < source_.size(); ++f) {
            if (source_[f] < 0) continue;
            const Triangle& now = fresh_.triangles[f];
            const Source& was = patches_.sources_[source_[f]];
            for (std::size_t k = 0; k < 3; ++k) {
                int &vertex = at(vertex_, was.vertex[k]), &normal = at(normal_, was.normal[k]);
                if (vertex < 0 && before[now.vertex[k]] < 0) {
                    vertex = now.vertex[k];
                    before[vertex] = was.vertex[k];
                }
                if (vertex != now.vertex[k] || before[vertex] != was.vertex[k]) forget(source_[f]);
                if (normal < 0) normal = now.normal[k];
            }
        }
    }

    static int& at(std::vector<int>& numbers, int index) {
        if (std::size_t(index) >= numbers.size()) numbers.resize(std::size_t(index) + 1, -1);
        return numbers[index];
    }

    bool stays(int facet) { return source_[facet] < 0 || !is_kept_[patch_of(source_[facet])]; }

    // Lists the triangles of the result: those of kept patches first, in their old order, then fresh facets that stay.
    std::vector<Piece> assemble() {
        std::vector<Piece> pieces;
        pieces.reserve(std::max(source_.size(), patches_.source_.size()));
        std::vector<int> first(is_kept_.size(), -1);  // first fresh facet of each patch
        for (int f = int(source_.size()); f-- > 0;)
            if (!stays(f)) first[patch_of(source_[f])] = f;
        for (std::size_t t = 0; t < patches_.source_.size(); ++t)
            if (const int patch = patch_of(patches_.source_[t]); is_kept_[patch])
                pieces.push_back({first[patch], int(t)});
        for (int f = 0; f < int(source_.size()); ++f)
            if (stays(f)) pieces.push_back({f});
        return pieces;
    }

    // The vertex of the fresh mesh at a corner; −1 if it was added by a change.
    int vertex_of(const Piece& piece, std::size_t corner) {
        if (piece.kept < 0) return fresh_.triangles[piece.facet].vertex[corner];
        const int source = patches_.vertices_[mesh_.triangles[piece.kept].vertex[corner]];
        return source < 0 ? -1 : vertex_[source];
    }

    // Drops patches with an inner edge that joins two vertices which an edge of other facets joins as well. Returns
    // whether there were any.
    bool drop_double_edges(const std::vector<Piece>& pieces) {
        std::vector<char> is_near(fresh_.positions.size(), false);
        for (const Piece& piece : pieces)
            if (piece.kept < 0)
                for (const int v : fresh_.triangles[piece.facet].vertex) is_near[v] = true;
        struct Edge {
            int a, b, facet;
            bool kept;
        };
        std::vector<Edge> edges;
        for (const Piece& piece : pieces)
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = vertex_of(piece, k), b = vertex_of(piece, (k + 1) % 3);
                if (a >= 0 && b >= 0 && is_near[a] && is_near[b]) edges.push_back({a, b, piece.facet, piece.kept >= 0});
            }
        std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& g) {
            return std::tie(e.a, e.b, e.facet) < std::tie(g.a, g.b, g.facet);
        });
        bool any = false;
        for (std::size_t k = 1; k < edges.size(); ++k)
            if (edges[k - 1].a == edges[k].a && edges[k - 1].b == edges[k].b)
                for (const Edge& edge : {edges[k - 1], edges[k]})
                    if (edge.kept) {
                        forget(source_[edge.facet]);
                        any = true;
                    }
        return any;
    }

    Patches insert(const std::vector<Piece>& pieces) {
        Patches result(fresh_, fresh_origins_);
        result.source_.clear();
        std::vector<Triangle> triangles;
        std::vector<Origin> origins;
        triangles.reserve(pieces.size());
        origins.reserve(pieces.size());
        put_vertices_.assign(mesh_.positions.size(), -1);
        put_normals_.assign(mesh_.normals.size(), -1);
        for (int f = 0; f < int(source_.size()); ++f)
            if (!stays(f)) join_in(result, f);
        for (const Piece& piece : pieces) {
            result.source_.push_back(piece.facet);
            origins.push_back(piece.kept < 0 ? fresh_origins_[piece.facet] : origins_[piece.kept]);
            triangles.push_back(piece.kept < 0 ? fresh_.triangles[piece.facet] : put(piece.kept));
        }
        result.vertices_.resize(fresh_.positions.size(), -1);
        result.normals_.resize(fresh_.normals.size(), -1);
        fresh_.triangles = std::move(triangles);
        fresh_origins_ = std::move(origins);
        return result;
    }

    void join_in(Patches& result, int facet) {
        int& first = at(first_of_patch_, patch_of(source_[facet]));
        if (first < 0) first = facet;
        result.joined_.join(first, facet);
    }

    Triangle put(int kept) {
        Triangle triangle = mesh_.triangles[kept];
        for (int& v : triangle.vertex) {
            int& number = put_vertices_[v];
            if (number < 0) {
                const int source = patches_.vertices_[v];
                number = source >= 0 ? vertex_[source] : int(fresh_.positions.size());
                if (source >= 0)
                    fresh_.positions[number] = mesh_.positions[v];  // vertices that moved are inside of the patch
                else
                    fresh_.positions.push_back(mesh_.positions[v]);
            }
            v = number;
        }
        for (int& n : triangle.normal) {
            int& number = put_normals_[n];
            if (number < 0) {
                const int source = patches_.normals_[n];
                number = source >= 0 && std::size_t(source) < normal_.size() ? normal_[source] : -1;
                if (number < 0 || fresh_.normals[number] != mesh_.normals[n]) {
                    number = int(fresh_.normals.size());
                    fresh_.normals.push_back(mesh_.normals[n]);
                }
            }
            n = number;
        }
        return triangle;
    }

    const Patches& patches_;
    Mesh& fresh_;
    std::vector<Origin>& fresh_origins_;
    const Mesh& mesh_;
    const std::vector<Origin>& origins_;
    UnionFind joined_;
    std::vector<char> is_kept_;                    // by patch
    std::vector<int> source_;                      // of each fresh facet; −1: none
    std::vector<int> vertex_, normal_;             // numbers in the fresh mesh, by number at the start
    std::vector<int> first_of_patch_;              // a fresh facet, by patch
    std::vector<int> put_vertices_, put_normals_;  // numbers in the fresh mesh, by number in the old mesh
};

Patches Patches::put_into(Mesh& fresh, std::vector<Origin>& fresh_origins, const Mesh& mesh,
                          const std::vector<Origin>& origins, std::span<const int> but) const {
    return Insertion(*this, fresh, fresh_origins, mesh, origins).run(but);
}

}  // namespace deburr
