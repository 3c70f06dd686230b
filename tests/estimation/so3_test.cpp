#include "estimation/so3.hpp"

#include <gtest/gtest.h>

#include <random>

namespace understory {
namespace {

std::vector<Eigen::Vector3d> rotation_vectors() {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Vector3d> vectors;
  for (const double angle : {0.0, 1e-9, 1e-5, 0.99e-4, 1.01e-4, 0.01, 1.0, 3.0, M_PI - 1e-6}) {
    Eigen::Vector3d axis;
    for (double& value : axis) value = uniform(generator);
    vectors.push_back(angle * axis.normalized());
  }
  return vectors;
}

TEST(So3, ExpAgreesWithEigensAxisAngle) {
  for (const Eigen::Vector3d& vector : rotation_vectors()) {
    const Eigen::Matrix3d plain =
        Eigen::AngleAxisd(vector.norm(), vector.stableNormalized()).toRotationMatrix();
    EXPECT_LT((so3::exp(vector) - plain).norm(), 1e-12) << vector.transpose();
  }
}

TEST(So3, LogUndoesExp) {
  for (const Eigen::Vector3d& vector : rotation_vectors()) {
    EXPECT_LT((so3::log(so3::exp(vector)) - vector).norm(), 1e-9) << vector.transpose();
  }
}

TEST(So3, RightJacobianAgreesWithFiniteDifferences) {
  constexpr double h = 1e-6;
  for (const Eigen::Vector3d& vector : rotation_vectors()) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d nudge = h * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d forward = so3::log(so3::exp(vector).transpose() * so3::exp(vector + nudge));
      const Eigen::Vector3d backward = so3::log(so3::exp(vector).transpose() * so3::exp(vector - nudge));
      EXPECT_LT(((forward - backward) / (2 * h) - so3::right_jacobian(vector).col(axis)).norm(), 1e-7);
    }
  }
}

TEST(So3, SkewIsTheCrossProduct) {
  const Eigen::Vector3d a(1, 2, 3), b(-4, 5, 0.5);
  EXPECT_LT((so3::skew(a) * b - a.cross(b)).norm(), 1e-15);
}

}  // namespace
}  // namespace understory
