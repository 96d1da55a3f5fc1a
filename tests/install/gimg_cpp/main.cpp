// A C++ program on gimg::gimg: writes an octahedron, reads it back and prints what it is.
#include <gimg/mesh.h>
#include <gimg/mesh_io.h>

#include <iostream>

int main()
{
    gimg::Mesh octahedron;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) octahedron.positions.push_back(side * gimg::Vec3::Unit(axis));
    octahedron.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

    if (const gimg::Status written = gimg::writeMesh(octahedron, "octahedron.ply"); !written) {
        std::cerr << written.error().message << '\n';
        return 1;
    }
    const gimg::Result<gimg::MeshFile> read = gimg::readMesh("octahedron.ply");
    if (!read) {
        std::cerr << read.error().message << '\n';
        return 1;
    }
    const gimg::Topology t = gimg::topology(read->mesh);
    std::cout << t.vertices << " vertices, " << t.faces << " faces, genus " << t.genus << ", diagonal "
              << gimg::boundingBoxDiagonal(read->mesh) << '\n';
}
