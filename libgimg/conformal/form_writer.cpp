#include "gimg/corner_map.h"
#include "mesh_output.h"

#include <exception>

namespace gimg {

Status writeForms(const Mesh& mesh, std::span<const Eigen::VectorXcd> forms, const std::string& path)
try {
    if (!path.ends_with(".ply"))
        return Error{ErrorKind::FormatUnknown, path + ": 1-forms are written to .ply"};
    for (const Eigen::VectorXcd& form : forms)
        if (form.size() != 3 * static_cast<Eigen::Index>(mesh.faceCount()))
            return Error{ErrorKind::BadArgument, path + ": " + std::to_string(form.size()) +
                                                     " numbers of a 1-form for " +
                                                     std::to_string(mesh.faceCount()) + " faces"};
    MeshOutput out;
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertexCount() << "\n";
    for (const char* name : {"x", "y", "z"}) out << "property double " << name << "\n";
    out << "element face " << mesh.faceCount() << "\nproperty list uchar int vertex_indices\n";
    for (size_t i = 0; i < forms.size(); ++i) out << "property list uchar double form_" << i << "\n";
    out << "end_header\n";
    for (const Vec3& p : mesh.positions)
        for (double x : p) out.binary(x);
    for (int f = 0; f < mesh.faceCount(); ++f) {
        out.binary(3, 1);
        for (int v : mesh.faces[f]) out.binary(static_cast<uint64_t>(v), 4);
        for (const Eigen::VectorXcd& form : forms) {
            out.binary(6, 1);
            for (int k = 0; k < 3; ++k) {
                out.binary(form[3 * f + k].real());
                out.binary(form[3 * f + k].imag());
            }
        }
    }
    return out.save(path);
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotWritable, path + ": " + failure.what()};
}

} // namespace gimg
