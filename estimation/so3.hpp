#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rotations and their logarithms, right (body-frame) perturbations throughout: R(true) = R(estimate) *
/// exp(delta). Formulas: Sola, Deray and Atchuthan, "A micro Lie theory for state estimation in robotics",
/// 2018, appendix B.
namespace understory::so3 {

/// The matrix with skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation by |vector| rad about vector.
Eigen::Matrix3d exp(const Eigen::Vector3d& rotation_vector);

/// Inverse of exp, its length in [0, pi]. `rotation` must be orthonormal.
Eigen::Vector3d log(const Eigen::Matrix3d& rotation);

/// J with exp(vector + small) = exp(vector) * exp(J * small), to first order in `small`.
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& rotation_vector);

}  // namespace understory::so3
