#include "compress/weave_fit/least_squares.h"

#include <ceres/ceres.h>

#include <exception>
#include <new>
#include <vector>

namespace
{

bool is_held(const weft_least_squares *problem, int i)
{
    return problem->low[i] >= problem->high[i];
}

class difference_cost final : public ceres::CostFunction
{
  public:
    explicit difference_cost(const weft_least_squares *given)
        : problem(given), scratch((size_t)given->parameter_count + (size_t)given->residual_count)
    {
        mutable_parameter_block_sizes()->push_back(given->parameter_count);
        set_num_residuals(given->residual_count);
    }

    bool Evaluate(double const *const *parameters, double *residuals, double **jacobians) const override
    {
        if (jacobians && jacobians[0])
            weft_least_squares_linearise(problem, parameters[0], residuals, jacobians[0], scratch.data());
        else
            problem->residuals(problem->context, parameters[0], residuals);
        return true;
    }

  private:
    const weft_least_squares *problem;
    mutable std::vector<double> scratch;
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

/* Held parameters leave the problem; the others get bounds. */
void constrain(ceres::Problem &problem, const weft_least_squares *given, double *parameters)
{
    std::vector<int> held;
    for (int i = 0; i < given->parameter_count; i++) {
        if (is_held(given, i)) {
            held.push_back(i);
            continue;
        }
        problem.SetParameterLowerBound(parameters, i, given->low[i]);
        problem.SetParameterUpperBound(parameters, i, given->high[i]);
    }
    if (!held.empty())
        problem.SetManifold(parameters, new ceres::SubsetManifold(given->parameter_count, held));
}

} // namespace

weft_code weft_least_squares_solve(const weft_least_squares *given, double *parameters, weft_error *error)
try {
    ceres::Problem problem;
    problem.AddResidualBlock(new difference_cost(given), nullptr, parameters);
    constrain(problem, given, parameters);
    ceres::Solver::Summary summary;
    ceres::Solve(quiet_options(), &problem, &summary);
    return check(summary, error);
} catch (const std::bad_alloc &) {
    return weft_fail_memory(error, "least squares", 0);
} catch (const std::exception &exception) {
    return weft_fail(error, WEFT_SYSTEM, "least squares: %s", exception.what());
}
