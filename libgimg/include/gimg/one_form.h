#pragma once

#include "gimg/mesh.h"
#include "gimg/polyhedral_surface.h"

#include <Eigen/Core>

#include <complex>
#include <span>

namespace gimg {

/// A discrete 1-form: one number per halfedge 3 f + k (see Halfedges), the integral along it; opposite on
/// twins. It is closed if the three numbers of every face add up to 0. A closed form stands for the
/// differential form that is constant on each triangle and has these integrals. Source: thesis §4.3, §4.10.
using OneForm = Eigen::VectorXd;
using ComplexOneForm = Eigen::VectorXcd;

/// df of a function on vertices: f(head) - f(tail).
OneForm exteriorDerivative(const Halfedges& halfedges, const Eigen::VectorXd& f);

/// The largest |sum around a face|: 0 for a closed form, but for rounding.
double closednessError(const OneForm& form);
double closednessError(const ComplexOneForm& form);

/// The integral along a chain of halfedges.
double integrate(const OneForm& form, std::span<const int> halfedges);
std::complex<double> integrate(const ComplexOneForm& form, std::span<const int> halfedges);

/// The integral over face f of a ^ b, for closed forms. Source: thesis eq. 46.
double wedge(const OneForm& a, const OneForm& b, int f);

/// The integral over the whole surface of a ^ b, for closed forms. On a closed surface it depends on their
/// cohomology classes only.
double wedge(const OneForm& a, const OneForm& b);

/// The integral over face f of a ^ *b = <a, b> dA, for closed forms, with *dx = dy and *dy = -dx in positive
/// coordinates. Source: thesis §4.10 (eq. 47 and 48; written with cotangents here, which is the same for
/// closed forms).
double starWedge(const PolyhedralSurface& surface, const OneForm& a, const OneForm& b, int f);

/// The integral over the whole surface of a ^ *b: the inner product of forms. starWedge(surface, a, a) is the
/// Dirichlet energy of a.
double starWedge(const PolyhedralSurface& surface, const OneForm& a, const OneForm& b);

} // namespace gimg
