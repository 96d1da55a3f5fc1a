#include "gimg/conformality.h"
#include "gimg/global_parameterization.h"

namespace gimg {
namespace {

// Vertices within so many edges of the given ones.
std::vector<bool> ringsAround(const Mesh& mesh, std::span<const int> vertices, int rings)
{
    std::vector<bool> in(mesh.positions.size(), false);
    for (int v : vertices) in[v] = true;
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<bool> wider = in;
        for (const Triangle& t : mesh.faces)
            if (in[t[0]] || in[t[1]] || in[t[2]]) wider[t[0]] = wider[t[1]] = wider[t[2]] = true;
        in.swap(wider);
    }
    return in;
}

} // namespace

AngleErrors angleErrors(const Mesh& mesh, const ComplexOneForm& form, std::span<const int> without, int rings)
{
    const std::vector<bool> out = ringsAround(mesh, without, rings);
    Mesh rest{mesh.positions, {}};
    std::vector<std::array<Vec2, 3>> image;
    AngleErrors errors;
    for (int f = 0; f < mesh.faceCount(); ++f) {
        const Triangle& t = mesh.faces[f];
        if (out[t[0]] || out[t[1]] || out[t[2]]) continue;
        const std::complex<double> first = form[3 * f], second = first + form[3 * f + 1];
        rest.faces.push_back(t);
        image.push_back({Vec2::Zero(), {first.real(), first.imag()}, {second.real(), second.imag()}});
        errors.flipped += (std::conj(first) * second).imag() <= 0;
    }
    errors.faces = rest.faceCount();
    const Conformality quality = conformality(rest, image);
    errors.medianDegrees = quality.medianAngleError;
    errors.degrees95 = quality.angleError95;
    errors.quasiConformalRatio = quality.quasiConformalRatio;
    return errors;
}

} // namespace gimg
