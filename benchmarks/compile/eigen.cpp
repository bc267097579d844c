// The measure of the others: one dense system of linear equations, solved with Eigen.
#include <Eigen/Dense>
#include <cstdio>

int main() {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(50, 50);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(50);
  const Eigen::VectorXd x = a.partialPivLu().solve(b);
  std::printf("residual %g\n", (a * x - b).norm());
}
