#pragma once

#include "gimg/homology.h"
#include "gimg/mesh.h"
#include "gimg/one_form.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// A neighbourhood of two loops that cross once: a torus with one hole.
struct HandleTorus
{
    Loop a, b;
    std::vector<int> faces;
};

/// One for each handle of a closed surface, no two with a face in common. Of the loops that separate nothing
/// and the shortest ways back to their other sides, each time those are taken that come nearest to the sides
/// of a rectangle, as the form measures lengths and periods.
/// @param mesh  closed, connected, manifold, oriented, of this genus
/// Errors: TargetUnreachable where no neighbourhood of such loops is a torus with one hole, apart from those
/// found before.
Result<std::vector<HandleTorus>> handleTori(const Mesh& mesh, const Halfedges& halfedges,
                                            const ComplexOneForm& form, int genus);

/// Two loops that meet in one vertex, where both begin, and cross there with a . b = 1.
struct CrossingLoops
{
    Loop a, b;
};

/// The shortest loop that separates nothing, and the shortest that crosses it so, as the form measures
/// length. Errors: TargetUnreachable where the mesh is too coarse.
/// @param mesh  closed, connected, manifold, oriented, genus >= 1
Result<CrossingLoops> crossingLoops(const Mesh& mesh, const Halfedges& halfedges, const ComplexOneForm& form);

} // namespace gimg
