#include "study/least_squares.h"

#include <ceres/ceres.h>

#include <cmath>
#include <exception>
#include <utility>
#include <vector>

namespace
{

struct residual_functor {
    const weft_least_squares *problem;

    bool operator()(double const *const *parameters, double *residuals) const
    {
        problem->residuals(problem->context, parameters[0], residuals);
        return true;
    }
};

ceres::Solver::Options quiet_options()
{
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.num_threads = 1;
    options.max_num_iterations = 40;
    options.function_tolerance = 1e-6;
    options.parameter_tolerance = 1e-6;
    options.gradient_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    return options;
}

weft_code check(const ceres::Solver::Summary &summary, weft_error *error)
{
    if (summary.IsSolutionUsable())
        return WEFT_OK;
    return weft_fail(error, WEFT_SYSTEM, "least squares: %s", summary.message.c_str());
}

/* Standard errors from the inverse of J'J; a parameter that is not determined has none. */
void estimate_deviation(ceres::Problem &problem, const weft_least_squares *given, const double *parameters, double cost,
                        double *deviation)
{
    int n = given->parameter_count, freedom = given->residual_count - n;
    std::vector<double> covariance(static_cast<size_t>(n) * static_cast<size_t>(n));
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    options.null_space_rank = -1;
    options.num_threads = 1;
    ceres::Covariance estimate(options);
    const std::vector<std::pair<const double *, const double *>> blocks = {{parameters, parameters}};
    bool known = freedom > 0 && estimate.Compute(blocks, &problem) &&
                 estimate.GetCovarianceBlock(parameters, parameters, covariance.data());
    for (int i = 0; i < n; i++) {
        double variance = covariance[static_cast<size_t>(i) * static_cast<size_t>(n + 1)];
        deviation[i] = known && variance > 0 ? std::sqrt(variance * 2 * cost / freedom) : INFINITY;
    }
}

void set_bounds(ceres::Problem &problem, double *parameters, int count, const double *low, const double *high)
{
    for (int i = 0; i < count; i++) {
        problem.SetParameterLowerBound(parameters, i, low[i]);
        problem.SetParameterUpperBound(parameters, i, high[i]);
    }
}

} // namespace

weft_code weft_least_squares_solve(const weft_least_squares *given, double *parameters, double *deviation,
                                   weft_error *error)
try {
    ceres::NumericDiffOptions steps;
    steps.relative_step_size = 1e-3;
    auto *cost = new ceres::DynamicNumericDiffCostFunction<residual_functor, ceres::FORWARD>(
        new residual_functor{given}, ceres::TAKE_OWNERSHIP, steps);
    cost->AddParameterBlock(given->parameter_count);
    cost->SetNumResiduals(given->residual_count);
    ceres::Problem problem;
    problem.AddResidualBlock(cost, nullptr, parameters);
    set_bounds(problem, parameters, given->parameter_count, given->low, given->high);
    ceres::Solver::Summary summary;
    ceres::Solve(quiet_options(), &problem, &summary);
    estimate_deviation(problem, given, parameters, summary.final_cost, deviation);
    return check(summary, error);
} catch (const std::exception &exception) {
    return weft_fail(error, WEFT_SYSTEM, "least squares: %s", exception.what());
}
