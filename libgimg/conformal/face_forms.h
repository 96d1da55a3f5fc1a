#pragma once

#include "gimg/mesh.h"
#include "gimg/one_form.h"

#include <Eigen/Core>

#include <span>

namespace gimg {

inline constexpr double kLeastFactor = 1e-300; ///< stands for a conformal factor of 0 where its log is taken

/// Forms as they are on each face: constant there, given by what they make of two orthonormal directions.
struct FaceForms
{
    Eigen::MatrixXcd x, y; ///< faces x forms; zero for faces without area
    Eigen::VectorXd share; ///< of each face in the surface's area
};

FaceForms faceForms(const Mesh& mesh, std::span<const ComplexOneForm> forms);

} // namespace gimg
