#pragma once

#include "embree_scene.h"

#include "gimg/mesh.h"

#include <vector>

namespace gimg {

/// The unit in which Embree's floats are safe: a mesh centred, its longest side between 1/2 and 1. The scale
/// is a power of two, so that it costs no precision.
struct UnitFrame
{
    Vec3 center = Vec3::Zero();
    double scale = 1;

    explicit UnitFrame(const Mesh& mesh);

    Vec3 inside(const Vec3& p) const { return (p - center) * scale; }
    Vec3 outside(const Vec3& p) const { return p / scale + center; }
    std::vector<Vec3> inside(const Mesh& mesh) const; ///< positions; zero for vertices in no face
};

/// To the triangle a b c; without area it counts as a segment or a point.
double squaredDistanceToTriangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Finds the nearest one of many triangles, in doubles. What is found does not depend on the shape of the
/// tree: of triangles at the same distance it is the first.
class NearestTree
{
public:
    struct Found
    {
        int face;
        double distance2;
    };

    NearestTree() = default;
    /// Throws std::bad_alloc. No queries are allowed where tooLarge().
    NearestTree(std::vector<Vec3> positions, const std::vector<Triangle>& faces);

    /// A coordinate so large that floats would not cull anything.
    bool tooLarge() const;

    const std::vector<Triangle>& faces() const { return faces_; }
    const std::vector<Vec3>& positions() const { return positions_; }

    /// @param near  any face; one near q saves time
    Found nearest(const Vec3& q, int near) const;

    /// The point of a face nearest to q, as weights of its corners.
    Vec3 nearestOnFace(const Vec3& q, int face) const;
    Vec3 pointOfFace(int face, const Vec3& weights) const;

    /// The square root of a distance2, or 0 where that is rounding.
    double distance(double distance2) const;

    /// Unit normals of the faces; needed for nearestNormal(), made when they are needed.
    void makeNormals();
    const Vec3& faceNormal(int face) const { return normals_[face]; } ///< zero: the face has none

    /// The unit normal of the surface at its point nearest to q: of the face where that point lies within
    /// one, else of all faces at the point, each weighted by the angle that it takes up there. Zero where
    /// they have no normal, or none together.
    /// @param found  in: any face; out: the nearest one
    /// Source: J. A. Baerentzen, H. Aanaes, Signed distance computation using the angle weighted
    /// pseudonormal, IEEE TVCG 11(3), 2005.
    Vec3 nearestNormal(const Vec3& q, Found& found) const;

private:
    struct Query;

    double distance2ToFace(const Vec3& q, int face) const;
    double distance2ToBox(const Vec3& q, int face) const; ///< of the face: not above that to the face
    double onePoint() const;
    double angleAt(const Vec3& p, int face) const;
    void search(Query& query) const;

    std::vector<Triangle> faces_;
    std::vector<Vec3> positions_;
    std::vector<Vec3> normals_;
    double extent_ = 0; ///< largest absolute coordinate
    EmbreeScene scene_;
};

} // namespace gimg
