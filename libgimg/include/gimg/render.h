#pragma once

#include "gimg/color.h"
#include "gimg/image_io.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <functional>
#include <optional>

namespace gimg {

inline constexpr Color kClay{205, 196, 182};
inline constexpr Color kInside{214, 40, 40}; ///< back faces: what shows through a crack
inline constexpr Color kPaper{255, 255, 255};

/// From where a mesh is looked at. The default looks from the front, a little from the right and from above,
/// at a mesh with y up and its face towards +z.
struct View
{
    Vec3 toward{-0.45, -0.3, -1}; ///< from the eye into the scene, of any length
    Vec3 up{0, 1, 0};             ///< need not be at right angles to `toward`, only not along it
};

/// An orthographic camera: what it shows does not depend on the size of the image.
struct Camera
{
    Vec3 right{1, 0, 0}, up{0, 1, 0}, toward{0, 0, -1}; ///< orthonormal
    Vec3 center = Vec3::Zero();                         ///< in the middle of the image
    double width = 1, height = 1; ///< at least so much of the scene is in the image, across and upwards
};

/// A camera that shows all of the mesh with a little room around it. Give several meshes the camera of one of
/// them, and their images can be laid over each other.
/// Errors: EmptyMesh, NotFinite, BadArgument (an index out of range, or `up` along `toward`).
Result<Camera> cameraFor(const Mesh& mesh, const View& view = {});

struct RenderOptions
{
    int width = 512; ///< of the image in pixels, as is `height`; at most 8192
    int height = 512;
    View view = {};                              ///< taken where there is no `camera`
    std::optional<Camera> camera = std::nullopt; ///< none: cameraFor(mesh, view)
    bool smooth = false;   ///< shaded by area-weighted vertex normals, not by face normals
    double shade = 1;      ///< 1: fully lit; 0: the colour itself, so that it can be read off a scale
    int supersampling = 3; ///< rays a pixel, across and upwards, at most 8
    int threads = 0;       ///< at most one a core; 0: as many. The image does not depend on it.
    Color surface = kClay;
    std::optional<Color> inside = kInside; ///< of back faces; none: the same as of front faces
    Color background = kPaper;
    /// The colour of a point of the surface, in place of `surface`: its face, its barycentric coordinates
    /// there and its place. Called from several threads at once, once for each ray that hits.
    std::function<Color(int face, const Vec3& barycentric, const Vec3& point)> color = nullptr;
};

/// Draws a mesh: nearest hit of parallel rays, lit from the upper left and faintly from the right, no
/// shadows. Of two triangles at exactly one depth the one of lower index is seen.
/// Errors: as cameraFor; BadArgument also for sizes and samplings out of range, and for a mesh that is 1e9
/// times as large or as far off as what the camera shows.
Result<RgbImage> render(const Mesh& mesh, const RenderOptions& options = {});

} // namespace gimg
