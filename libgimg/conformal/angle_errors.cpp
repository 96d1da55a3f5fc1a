#include "gimg/conformality.h"
#include "gimg/global_parameterization.h"

namespace gimg {

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
