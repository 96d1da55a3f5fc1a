#include "conformal/face_forms.h"

namespace gimg {

FaceForms faceForms(const Mesh& mesh, std::span<const ComplexOneForm> forms)
{
    const Eigen::Index count = mesh.faceCount(), n = static_cast<Eigen::Index>(forms.size());
    FaceForms faces{Eigen::MatrixXcd::Zero(count, n), Eigen::MatrixXcd::Zero(count, n),
                    Eigen::VectorXd::Zero(count)};
    for (Eigen::Index f = 0; f < count; ++f) {
        const Triangle& t = mesh.faces[static_cast<size_t>(f)];
        const Vec3 along = mesh.positions[t[1]] - mesh.positions[t[0]];
        const Vec3 other = mesh.positions[t[2]] - mesh.positions[t[0]];
        const double length = along.norm(), doubleArea = along.cross(other).norm();
        if (!(doubleArea > 0)) continue;
        const double a = other.dot(along) / length, b = doubleArea / length; // `other` in the face's frame
        for (Eigen::Index i = 0; i < n; ++i) {
            const ComplexOneForm& form = forms[static_cast<size_t>(i)];
            faces.x(f, i) = form[3 * f] / length;
            faces.y(f, i) = (-form[3 * f + 2] - a * faces.x(f, i)) / b;
        }
        faces.share[f] = doubleArea / 2;
    }
    const double area = faces.share.sum();
    if (area > 0) faces.share /= area;
    return faces;
}

} // namespace gimg
