/* Linear algebra by Eigen, which Ceres Solver stands on. */
#include "study/fit_weave/least_squares.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <exception>
#include <new>
#include <vector>

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;
using row_major = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/* Eigenvalues of J'J, columns at unit length, below which nothing is determined. */
constexpr double least_eigenvalue = 1e-9;

/* Share of an undetermined direction in a parameter that is not determined either. */
constexpr double large_share = 1e-2;

/* Keeps (I - M_c) regular where a cluster alone determines a direction. */
constexpr double ridge = 1e-6;

/* parameters = to_parameters * y, in which J'J is the identity. */
struct whitening {
    MatrixXd to_parameters;
    std::vector<bool> held, unknown;
};

whitening whitening_of(const Eigen::Map<const row_major> &jacobian)
{
    Eigen::Index n = jacobian.cols(), kept = 0;
    whitening result{MatrixXd::Zero(n, n), std::vector<bool>(static_cast<size_t>(n)),
                     std::vector<bool>(static_cast<size_t>(n))};
    VectorXd length = jacobian.colwise().norm(), inverse = VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; i++) {
        result.held[static_cast<size_t>(i)] = !(length[i] > 0);
        inverse[i] = length[i] > 0 ? 1 / length[i] : 0;
    }
    MatrixXd scaled = jacobian * inverse.asDiagonal();
    Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled.transpose() * scaled);
    for (Eigen::Index k = 0; k < n; k++) {
        double value = solver.eigenvalues()[k];
        VectorXd direction = solver.eigenvectors().col(k);
        if (value > least_eigenvalue) {
            result.to_parameters.col(kept++) = inverse.asDiagonal() * direction / std::sqrt(value);
            continue;
        }
        for (Eigen::Index i = 0; i < n; i++)
            if (direction[i] * direction[i] > large_share && !result.held[static_cast<size_t>(i)])
                result.unknown[static_cast<size_t>(i)] = true;
    }
    result.to_parameters.conservativeResize(Eigen::NoChange, kept);
    return result;
}

/* Sums over one cluster, whitened. */
struct cluster_sums {
    MatrixXd square;
    VectorXd gradient;
};

std::vector<cluster_sums> sum_clusters(const weft_linearised *solution, const row_major &white, const int *cluster,
                                       int cluster_count)
{
    Eigen::Index n = white.cols();
    std::vector<cluster_sums> sums(static_cast<size_t>(cluster_count), {MatrixXd::Zero(n, n), VectorXd::Zero(n)});
    for (int row = 0; row < solution->rows; row++) {
        cluster_sums &own = sums[static_cast<size_t>(cluster[row])];
        VectorXd direction = white.row(row).transpose();
        own.square.noalias() += direction * direction.transpose();
        own.gradient += direction * solution->residuals[row];
    }
    return sums;
}

VectorXd sum_of_squared_changes(const std::vector<cluster_sums> &sums, const MatrixXd &to_parameters)
{
    Eigen::Index n = to_parameters.cols();
    VectorXd total = VectorXd::Zero(to_parameters.rows());
    for (const cluster_sums &own : sums) {
        MatrixXd others = (1 + ridge) * MatrixXd::Identity(n, n) - own.square;
        VectorXd change = to_parameters * others.ldlt().solve(own.gradient);
        total += change.cwiseAbs2();
    }
    return total;
}

} // namespace

weft_code weft_jackknife_variance(const weft_linearised *solution, const int *cluster, int cluster_count,
                                  double *variance, weft_error *error)
try {
    Eigen::Map<const row_major> jacobian(solution->jacobian, solution->rows, solution->columns);
    whitening white = whitening_of(jacobian);
    row_major rows = jacobian * white.to_parameters;
    VectorXd total = sum_of_squared_changes(sum_clusters(solution, rows, cluster, cluster_count), white.to_parameters);
    for (int i = 0; i < solution->columns; i++) {
        bool unknown = white.unknown[static_cast<size_t>(i)] || cluster_count < 2 || !std::isfinite(total[i]);
        variance[i] = white.held[static_cast<size_t>(i)] ? 0
                      : unknown                          ? INFINITY
                                                         : total[i] * (cluster_count - 1) / cluster_count;
    }
    return WEFT_OK;
} catch (const std::bad_alloc &) {
    return weft_fail_memory(error, "standard errors", 0);
} catch (const std::exception &exception) {
    return weft_fail(error, WEFT_SYSTEM, "standard errors: %s", exception.what());
}
