#pragma once

#include "gimg/corner_map.h"
#include "gimg/cut.h"
#include "gimg/double_cover.h"
#include "gimg/holomorphic.h"
#include "gimg/mesh.h"
#include "gimg/one_form.h"
#include "gimg/result.h"

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace gimg {

/// The holomorphic 1-forms of a surface with or without boundary. Each maps the surface to the plane,
/// conformally but for its zeros, without a border that anyone chose.
struct SurfaceForms
{
    /// On the surface's halfedges. A closed surface of genus g has the g forms of ConformalStructure, and
    /// their complex combinations. A surface of genus g with b loops has 2 g + b - 1 forms that are real
    /// along the boundary, so that every loop of it becomes horizontal lines, and their real combinations.
    std::vector<ComplexOneForm> basis;

    ConformalStructure structure;           ///< of the surface, or of its double covering
    std::optional<DoubleCover> cover;       ///< of a surface with boundary
    std::vector<ComplexOneForm> coverBasis; ///< the same forms on the covering

    bool hasBoundary() const { return cover.has_value(); }
};

/// @param mesh  connected, manifold, oriented
/// Errors: those of conformalStructure for the surface or its double covering; WrongGenus where there are no
/// forms (genus 0 with at most one boundary loop). Source: thesis chapter 6 and §7.5.
Result<SurfaceForms> surfaceForms(const Mesh& mesh, const ConformalOptions& options = {});

/// sum of c_i basis_i. @param c  as many as there are forms
ComplexOneForm combination(std::span<const ComplexOneForm> basis, const Eigen::VectorXcd& c);

/// A surface in the plane: a 1-form integrated over the surface cut open to a disk.
struct PlaneMap
{
    CornerMap map;
    CutGraph cut;
    /// Per path of `cut`: the map on its right side less that on its left, one number all along the path. It
    /// is a period of the form: an integer combination of its integrals along the loops of a basis. 0 for
    /// boundary paths.
    std::vector<std::complex<double>> jumps;
    double jumpError = 0; ///< largest change of a jump along its path, relative to the diameter of the map
};

/// @param mesh  connected, manifold, oriented, not a closed surface of genus 0
/// @param form  closed
/// Errors: BadArgument for a form of another size; those of openAlong. Source: thesis §7, Algorithm 9.
Result<PlaneMap> integrateOverDisk(const Mesh& mesh, const ComplexOneForm& form);

/// A zero of a holomorphic form. A small circle around it goes around its image 1 + multiplicity times.
struct BranchPoint
{
    int vertex = 0; ///< the nearest
    /// Mean of the vertices that have angle in excess of a full turn, by how much.
    Vec3 position = Vec3::Zero();
    int multiplicity = 0; ///< > 0
};

/// All zeros of a form, found by counting turns.
struct BranchPoints
{
    std::vector<BranchPoint> points;
    int total = 0;    ///< sum of the indices of all places: 2 g - 2
    int negative = 0; ///< places of negative index, which no holomorphic form has: 0
};

/// The triangles of a closed form lie in the plane. Around each vertex their angles, negative in flipped
/// triangles, add up to 2 pi (1 + k) with an integer k; the indices k of vertices and 1 of flipped triangles
/// add up to 2 g - 2 (see docs/global.md). Counted on the intrinsic Delaunay triangulation, where a form that
/// is harmonic on it has no places of negative index. A patch of flipped triangles is one place with all its
/// vertices; so is one where the form is below 1e-13 of its largest value, as it is far out on a limb, and
/// its index is that of a walk around it.
/// @param mesh  closed, connected, manifold, oriented
/// @param form  closed, on the mesh's halfedges
/// Errors: those of IntrinsicTriangulation::of; BadArgument for a form of another size.
/// Source: thesis §7.1, where branch points are the vertices of least stretch.
Result<BranchPoints> branchPoints(const Mesh& mesh, const ComplexOneForm& form);

/// Those of a surface with boundary, by way of its covering: zeros inside count twice there, those on the
/// boundary once. Errors: as above.
struct BoundedBranchPoints
{
    BranchPoints inside;
    BranchPoints onBoundary;
    int total = 0; ///< on the covering of genus G: 2 G - 2
};
Result<BoundedBranchPoints> branchPoints(const DoubleCover& cover, const ComplexOneForm& formOnCover);

/// Per face: (s^2 + t^2) / 2 with the singular values s and t of the form, which is area in the plane over
/// area on the surface where the form is conformal; 0 for faces without area. Its local minima are the branch
/// points.
std::vector<double> conformalFactor(const Mesh& mesh, const ComplexOneForm& form);

/// Per vertex: the mean over the edges there of |form|^2 / length^2, the square of how much longer they
/// become. The thesis looks for branch points where it is least. Source: thesis eq. 89.
std::vector<double> vertexStretch(const Mesh& mesh, const ComplexOneForm& form);

/// How unevenly a form spreads the surface: log of the mean of the conformal factor less the mean of its log,
/// means over the surface's area. 0 if all of the surface is scaled alike, otherwise positive; finite in
/// spite of zeros; the same for all multiples of a form.
double unevenness(const Mesh& mesh, const ComplexOneForm& form);

/// The combination of forms that spreads the surface most evenly.
struct UniformForm
{
    Eigen::VectorXcd coefficients; ///< real where only real combinations count
    ComplexOneForm form;           ///< scaled so that the mean conformal factor is 1
    double unevenness = 0;
    int starts = 0;     ///< descents made
    int iterations = 0; ///< of the last one, over all faces
};

/// Least unevenness over all combinations, which are the unit sphere of coefficients but for scale: descent
/// from as many starts as there are forms and 12 more, on some of the faces, and over all faces from the best
/// of them. A local minimum, the same in every run.
/// @param realOnly  only real combinations
/// Errors: BadArgument where there is no form, one of another size, or only forms that vanish.
Result<UniformForm> mostUniformForm(const Mesh& mesh, std::span<const ComplexOneForm> basis, bool realOnly);

/// How far the triangles of a form are from those of the surface.
struct AngleErrors
{
    double medianDegrees = 0;       ///< |angle in the plane - angle on the surface| over all corners
    double degrees95 = 0;           ///< 95 % of the corners have no more
    double quasiConformalRatio = 1; ///< mean over area of the larger singular value over the smaller
    int faces = 0;                  ///< that were looked at
    int flipped = 0;                ///< of those
};

/// @param without  vertices: faces within `rings` rings around them are left out
AngleErrors angleErrors(const Mesh& mesh, const ComplexOneForm& form, std::span<const int> without,
                        int rings = 2);

/// Vertices within so many edges of the given ones.
std::vector<bool> ringsAround(const Mesh& mesh, std::span<const int> vertices, int rings);

/// Vertices to puncture() so that the surface is spread more evenly: one after the other, each the far end of
/// what the most even map shrinks most, a limb as a rule. A surface without forms is first punctured at its
/// ends: the vertex farthest from its boundary, or one end of the longest way. Computes the forms `count`
/// times. Errors: those of surfaceForms; BadArgument where `count` is below 1 or no vertex can be left out.
/// Source: thesis §7.5, where holes are made by hand.
Result<std::vector<int>> findPunctures(const Mesh& mesh, int count, const ConformalOptions& options = {});

} // namespace gimg
