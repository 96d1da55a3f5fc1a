#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace gimg::adapter {

/// One mesh at ever fewer triangles, as a simplifier leaves it. Rung 0 is the mesh itself; the others are
/// kRungRatio apart, except that a ladder may leave out those between the mesh and the first that is wanted.
class Ladder
{
public:
    static constexpr double kRungRatio = 0.97; ///< triangles of a rung, of those of the rung above
    static constexpr int kStepsBetween = 9;    ///< meshes that between() gives where there is room

    virtual ~Ladder() = default;
    virtual int size() const = 0;
    virtual const Mesh& rung(int i) = 0;
    /// Meshes between rung i and rung i + 1, neither included, in order of falling triangle count.
    virtual std::vector<Mesh> between(int i) = 0;
};

/// Without the vertices that no face has.
Mesh referenced(const Mesh& mesh);

/// Numbers of triangles from `most`, or a little fewer, down to kFewestTriangles, a rung apart.
std::vector<std::size_t> rungCounts(std::size_t most);
constexpr std::size_t kFewestTriangles = 20;

/// At most kStepsBetween numbers between two others, neither included, spread evenly, falling.
std::vector<std::size_t> countsBetween(std::size_t more, std::size_t fewer);

/// Edge collapse by Lindstrom and Turk (memoryless volume and boundary optimisation), CGAL's with its default
/// weights. All rungs are made here, in one run over the mesh.
/// @param mostTriangles  of the rungs below the mesh itself
/// Errors: NonManifoldEdge where the mesh is not an oriented manifold.
Result<std::unique_ptr<Ladder>> lindstromTurkLadder(const Mesh& mesh, std::size_t mostTriangles);

/// meshopt_simplify without a limit on the error, each rung from the mesh itself. Rungs are made when first
/// asked for, so `mostTriangles` does not matter.
Result<std::unique_ptr<Ladder>> meshoptLadder(const Mesh& mesh, std::size_t mostTriangles);

} // namespace gimg::adapter
