#include "registration/axes/adjustment.h"

#include <ceres/ceres.h>

#include <exception>
#include <new>
#include <vector>

namespace
{

constexpr int own_count = WEFT_OWN_UNKNOWNS;

/* Of a standard deviation: far above rounding, far below any curvature. */
constexpr double step = 1e-4;

using matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/* The residuals of a group, with central differences for derivatives. */
class group_cost : public ceres::CostFunction
{
  public:
    group_cost(const weft_adjustment *of, int number) : adjustment(of), group(number)
    {
        set_num_residuals(of->residuals);
        mutable_parameter_block_sizes()->push_back(of->shared);
        mutable_parameter_block_sizes()->push_back(own_count);
    }

    bool Evaluate(double const *const *unknowns, double *residuals, double **jacobians) const override
    {
        adjustment->residual(adjustment->context, group, unknowns[0], unknowns[1], residuals);
        for (int block = 0; jacobians && block < 2; block++)
            if (jacobians[block])
                differentiate(unknowns, block, jacobians[block]);
        for (int i = 0; i < num_residuals(); i++)
            if (!std::isfinite(residuals[i]))
                return false;
        return true;
    }

  private:
    const weft_adjustment *adjustment;
    int group;

    void differentiate(double const *const *unknowns, int block, double *jacobian) const
    {
        const int columns = parameter_block_sizes()[(size_t)block], rows = num_residuals();
        std::vector<double> moved(unknowns[block], unknowns[block] + columns), above((size_t)rows), below(above);
        const double *at[2] = {unknowns[0], unknowns[1]};
        at[block] = moved.data();
        for (int column = 0; column < columns; column++) {
            double &value = moved[(size_t)column];
            const double centre = value;
            value = centre + step;
            adjustment->residual(adjustment->context, group, at[0], at[1], above.data());
            value = centre - step;
            adjustment->residual(adjustment->context, group, at[0], at[1], below.data());
            value = centre;
            for (int row = 0; row < rows; row++)
                jacobian[row * columns + column] = (above[(size_t)row] - below[(size_t)row]) / (2 * step);
        }
    }
};

/* An unknown is itself a residual: it is 0 within 1 beforehand. */
class prior_cost : public ceres::CostFunction
{
  public:
    explicit prior_cost(int count)
    {
        set_num_residuals(count);
        mutable_parameter_block_sizes()->push_back(count);
    }

    bool Evaluate(double const *const *unknowns, double *residuals, double **jacobians) const override
    {
        const int count = num_residuals();
        std::copy_n(unknowns[0], count, residuals);
        if (jacobians && jacobians[0])
            for (int i = 0; i < count * count; i++)
                jacobians[0][i] = i % (count + 1) == 0 ? 1 : 0;
        return true;
    }
};

ceres::Solver::Summary solve(const weft_adjustment &a, weft_adjusted *adjusted)
{
    ceres::Problem problem;
    auto *order = new ceres::ParameterBlockOrdering;
    ceres::Solver::Options options;
    options.linear_solver_ordering.reset(order);
    problem.AddResidualBlock(new prior_cost(a.shared), nullptr, adjusted->shared);
    order->AddElementToGroup(adjusted->shared, 1);
    for (int group = 0; group < a.groups; group++) {
        problem.AddResidualBlock(new group_cost(&a, group), nullptr, adjusted->shared, adjusted->own[group]);
        problem.AddResidualBlock(new prior_cost(own_count), nullptr, adjusted->own[group]);
        order->AddElementToGroup(adjusted->own[group], 0);
    }
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = 60;
    options.function_tolerance = 1e-9;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    adjusted->squares = 2 * summary.final_cost;
    return summary;
}

struct group_information {
    matrix own_inverse, coupling; /* [own][own], [own][shared] */
};

/* The shared unknowns' covariance with the own ones eliminated (Schur's complement), then that of each group. */
void propagate(const weft_adjustment &a, weft_adjusted *adjusted)
{
    std::vector<group_information> groups((size_t)a.groups);
    matrix information = matrix::Identity(a.shared, a.shared);
    for (int group = 0; group < a.groups; group++) {
        group_cost cost(&a, group);
        matrix shared(a.residuals, a.shared), own(a.residuals, own_count);
        std::vector<double> residuals((size_t)a.residuals);
        const double *unknowns[2] = {adjusted->shared, adjusted->own[group]};
        double *jacobians[2] = {shared.data(), own.data()};
        cost.Evaluate(unknowns, residuals.data(), jacobians);
        group_information &g = groups[(size_t)group];
        g.own_inverse = (matrix::Identity(own_count, own_count) + own.transpose() * own).inverse();
        g.coupling = own.transpose() * shared;
        information += shared.transpose() * shared - g.coupling.transpose() * g.own_inverse * g.coupling;
    }
    const matrix covariance = information.inverse();
    std::copy_n(covariance.data(), (size_t)a.shared * (size_t)a.shared, adjusted->covariance);
    for (int group = 0; group < a.groups; group++) {
        const group_information &g = groups[(size_t)group];
        const matrix gain = g.own_inverse * g.coupling;
        const matrix variance = g.own_inverse + gain * covariance * gain.transpose();
        for (int i = 0; i < own_count; i++)
            adjusted->own_variance[group][i] = variance(i, i);
    }
}

} // namespace

weft_code weft_adjust(const weft_adjustment *adjustment, weft_adjusted *adjusted, weft_error *error)
{
    try {
        const ceres::Solver::Summary summary = solve(*adjustment, adjusted);
        if (!summary.IsSolutionUsable())
            return weft_fail(error, WEFT_BAD_INPUT, "no poses fit the shots");
        propagate(*adjustment, adjusted);
        return WEFT_OK;
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, "an adjustment", 0);
    } catch (const std::exception &cause) {
        return weft_fail(error, WEFT_SYSTEM, "Ceres: %s", cause.what());
    }
}
