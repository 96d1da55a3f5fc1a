#pragma once

#include "sweep_folder.h"
#include "sweep_plan.h"

#include "gimg/distance.h"
#include "gimg/mesh.h"
#include "gimg/render.h"
#include "gimg/result.h"

#include <filesystem>
#include <memory>
#include <string>

namespace gimg::gimrd {

/// A mesh of a sweep, ready to be coded and compared with. What readMesh() makes of its file or, where that
/// refuses it, the triangles as they are: those can be measured and coded by coders that take any triangles,
/// but not by ours.
struct SweepReference
{
    Mesh mesh;
    std::string note; ///< why readMesh refused the file; empty if it did not
    double diagonal = 0;
    SurfaceMeasure measure;
    Camera camera;
    std::filesystem::path ply; ///< the mesh as a file, what mesh coders get
};

/// Reads the mesh, writes it to the folder for the coders, and draws its thumbnail.
/// @param sha256  of the mesh's file: what is made from it carries a part of that in its name
/// Errors: those of readMesh, readTriangles and readF32; FileNotWritable.
Result<std::shared_ptr<SweepReference>> makeReference(const SweepMesh& mesh, const std::string& sha256,
                                                      SweepFolder& folder, int samples, int threads);

/// The geometry image that image coders get: the file itself if it is one, and otherwise our own encoding
/// without loss, made once and kept in the folder. Errors: of encodeMesh; FileNotWritable.
Result<std::filesystem::path> makeGridImage(const SweepMesh& mesh, const std::string& sha256,
                                            const SweepReference& reference, int grid, SweepFolder& folder,
                                            int threads);

/// Draws a decoded mesh as the reference is drawn. Errors: of render(); FileNotWritable.
Status drawThumbnail(const Mesh& mesh, const Camera& camera, SweepFolder& folder,
                     const std::filesystem::path& place, int threads);

} // namespace gimg::gimrd
