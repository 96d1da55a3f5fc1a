#pragma once

#include "gimg/corner_map.h"
#include "gimg/homology.h"
#include "gimg/mesh.h"
#include "gimg/one_form.h"
#include "gimg/result.h"

#include <complex>
#include <vector>

namespace gimg {

/// One handle of a closed surface: a region that is a torus with holes, and what a form makes of it.
struct Handle
{
    Loop a, b;                        ///< cross once, a . b = 1; no loop of another handle touches them
    std::complex<double> periodA = 0; ///< of the form along a, as is periodB along b
    std::complex<double> periodB = 0;
    std::vector<Loop> boundary; ///< of the region, which lies to the left: the separators
    double area = 0;            ///< of the region in the plane, flipped triangles negative

    /// Of the parallelogram of the periods. The handle maps onto it where its separators are slits: made of
    /// two copies of one line in the plane each.
    double parallelogramArea() const { return (std::conj(periodA) * periodB).imag(); }
};

/// A closed surface of genus g as g handles.
struct HandleSeparation
{
    std::vector<Handle> handles;
    std::vector<int> handleOf; ///< per face
};

/// Separates the handles of a closed surface along the shortest curves, as the form measures length. Such
/// curves are straight in the plane but for corners at branch points, where length costs nothing to turn.
/// Handles are found one by one: of short loops that separate nothing, each with the shortest path back to
/// its other side, the pair whose periods come nearest to a rectangle. The region between the neighbourhoods
/// of the pairs is divided by minimal cuts of the graph of faces, one for each handle, that keep it apart
/// from all others.
/// @param mesh  closed, connected, manifold, oriented, genus g >= 1
/// @param form  closed, on the halfedges
/// Errors: BadArgument for a form of another size; WrongGenus for genus 0; NotClosed; TargetUnreachable where
/// the mesh is so coarse that the neighbourhoods of two loops overlap (subdivided() helps).
/// Source: thesis §7.2 and §7.3, where curves between pairs of branch points are looked for in the plane;
/// Dahlhaus et al. 1994, "The complexity of multiterminal cuts".
Result<HandleSeparation> separateHandles(const Mesh& mesh, const ComplexOneForm& form);

/// The place of every corner in the parallelogram of its handle: coordinates (s, t) stand for s periodA + t
/// periodB; across an edge inside a handle they change by integers, and the first corner of every face lies
/// in [0,1)^2 (but for 1e-12). A texture that repeats with the unit square has no seam but the separators.
/// @param form  the same as for separateHandles
/// Errors: BadArgument where a parallelogram has no area.
Result<CornerMap> modularCoordinates(const Mesh& mesh, const ComplexOneForm& form,
                                     const HandleSeparation& separation);

/// A mesh with every triangle split into four, and a form on it. The surface and the form stay what they are.
struct SubdividedForm
{
    Mesh mesh; ///< face f becomes faces 4 f to 4 f + 3, the last of which is the middle one
    ComplexOneForm form;
};
SubdividedForm subdivided(const Mesh& mesh, const ComplexOneForm& form);

} // namespace gimg
