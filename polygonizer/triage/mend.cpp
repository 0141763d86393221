#include "polygonizer/triage/mend.hpp"

#include "bounds/sort_once.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "polygonizer/mesh/degenerate_shells.hpp"
#include "polygonizer/mesh/repair.hpp"
#include "polygonizer/triage/rounds.hpp"

namespace deburr {

MendedMesh mend(Mesh mesh, std::vector<Origin> origins, const FacetJudge& judge, double tolerance, bool may_split,
                CancelFlag cancel) {
    MendedMesh m;
    m.mesh = std::move(mesh);
    m.origins = std::move(origins);
    RepairStatistics repaired = repair(m.mesh, m.origins, judge, tolerance, may_split);
    drop_wrong_shells(m.mesh, m.origins, repaired.left);
    m.farthest = repaired.farthest;
    m.leaning = repaired.left.size();
    m.others = add_crossing(m.mesh, repaired.left, cancel);
    m.crosses = m.others > 0;
    if (std::isfinite(tolerance)) m.others += add_far(m.mesh, judge, tolerance, repaired.left);
    sort_once(repaired.left);
    m.wrong = std::move(repaired.left);
    return m;
}

}  // namespace deburr
