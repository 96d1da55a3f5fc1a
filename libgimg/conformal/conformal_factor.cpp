#include "conformal/face_forms.h"
#include "gimg/global_parameterization.h"

#include <cmath>

namespace gimg {

std::vector<double> conformalFactor(const Mesh& mesh, const ComplexOneForm& form)
{
    const FaceForms faces = faceForms(mesh, {&form, 1});
    std::vector<double> factor(mesh.faces.size());
    for (size_t f = 0; f < factor.size(); ++f) {
        const Eigen::Index row = static_cast<Eigen::Index>(f);
        factor[f] = (std::norm(faces.x(row, 0)) + std::norm(faces.y(row, 0))) / 2;
    }
    return factor;
}

std::vector<double> vertexStretch(const Mesh& mesh, const ComplexOneForm& form)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<double> sum(mesh.positions.size(), 0.0), edges(mesh.positions.size(), 0.0);
    for (int h = 0; h < he.count(); ++h) {
        if (he.twin(h) > h) continue; // each edge once
        const double length2 = (mesh.positions[he.head(h)] - mesh.positions[he.tail(h)]).squaredNorm();
        for (int v : {he.tail(h), he.head(h)}) {
            if (length2 > 0) sum[v] += std::norm(form[h]) / length2;
            edges[v] += 1;
        }
    }
    for (size_t v = 0; v < sum.size(); ++v)
        if (edges[v] > 0) sum[v] /= edges[v];
    return sum;
}

double unevenness(const Mesh& mesh, const ComplexOneForm& form)
{
    const FaceForms faces = faceForms(mesh, {&form, 1});
    const std::vector<double> factor = conformalFactor(mesh, form);
    double mean = 0, meanLog = 0;
    for (size_t f = 0; f < factor.size(); ++f) {
        const double share = faces.share[static_cast<Eigen::Index>(f)];
        if (!(share > 0)) continue;
        mean += share * factor[f];
        meanLog += share * std::log(std::max(factor[f], kLeastFactor));
    }
    return std::log(std::max(mean, kLeastFactor)) - meanLog;
}

} // namespace gimg
