// A C++ program on gimg::gimg: an octahedron to a file and back, then coded as a geometry image and decoded.
#include <gimg/decode.h>
#include <gimg/encode.h>
#include <gimg/mesh_io.h>

#include <iostream>

namespace {

void print(const char* what, const gimg::Mesh& mesh)
{
    const gimg::Topology t = gimg::topology(mesh);
    std::cout << what << ": " << t.vertices << " vertices, " << t.faces << " faces, genus " << t.genus
              << ", loops " << t.boundaries << ", diagonal " << gimg::boundingBoxDiagonal(mesh) << '\n';
}

int refuse(const gimg::Error& error)
{
    std::cerr << error.message << '\n';
    return 1;
}

} // namespace

int main()
{
    gimg::Mesh octahedron;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) octahedron.positions.push_back(side * gimg::Vec3::Unit(axis));
    octahedron.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

    const gimg::Status written = gimg::writeMesh(octahedron, "octahedron.ply");
    if (!written) return refuse(written.error());
    const gimg::Result<gimg::MeshFile> read = gimg::readMesh("octahedron.ply");
    if (!read) return refuse(read.error());
    print("read", read->mesh);

    gimg::EncodeOptions options;
    options.target = gimg::EncodeTarget::RawFloat;
    options.grid = 65;
    const gimg::Result<gimg::EncodedMesh> encoded = gimg::encodeMesh(read->mesh, options);
    if (!encoded) return refuse(encoded.error());
    const gimg::Result<gimg::DecodedImages> images = gimg::decodeImages(encoded->file);
    if (!images) return refuse(images.error());
    const gimg::Result<gimg::Mesh> decoded = gimg::levelMesh(encoded->file, *images, 0);
    if (!decoded) return refuse(decoded.error());
    print("decoded", *decoded);
}
