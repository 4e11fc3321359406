#include "bench/fit/ceres_bridge.h"

#include <ceres/ceres.h>

#include <cmath>
#include <memory>

namespace
{

constexpr double LARGEST_SHAPE = 1.5;
constexpr double FIRST_RADIUS = 10; /* of all tried the one that ends soonest and lowest; Ceres would take 1e4 */

/* Residuals of one view. Parameters: the lobes and, where it is not fixed, T(v). */
class ViewResiduals : public ceres::CostFunction
{
  public:
    ViewResiduals(problem *given, int view, const double *fixed_table)
        : given_(given), view_(view), fixed_table_(fixed_table)
    {
        set_num_residuals(given->first[view + 1] - given->first[view]);
        mutable_parameter_block_sizes()->push_back(given->parameter_count);
        if (!fixed_table)
            mutable_parameter_block_sizes()->push_back(1);
    }

    bool Evaluate(double const *const *parameters, double *residuals, double **jacobians) const override
    {
        const int begin = given_->first[view_], end = given_->first[view_ + 1];
        const double t = fixed_table_ ? fixed_table_[view_] : parameters[1][0];
        given_->code->evaluate(given_, parameters[0], begin, end);
        double sum = 0;
        for (int i = begin; i < end; i++) {
            residuals[i - begin] = given_->value[i] - t * given_->model[i];
            sum += residuals[i - begin];
        }
        given_->passes += view_ == 0;
        if (!std::isfinite(sum))
            return false; /* a power overflowed: Ceres takes a shorter step */
        if (jacobians && jacobians[0])
            write_lobe_derivatives(parameters[0], t, jacobians[0]);
        if (jacobians && !fixed_table_ && jacobians[1]) {
            for (int i = begin; i < end; i++)
                jacobians[1][i - begin] = -given_->model[i];
        }
        return true;
    }

  private:
    void write_lobe_derivatives(const double *x, double t, double *rows) const
    {
        const int begin = given_->first[view_], end = given_->first[view_ + 1], n = given_->parameter_count;
        const long stride = given_->sample_count;
        given_->code->differentiate(given_, x, begin, end);
        for (int p = 0; p < n; p++) {
            for (int i = begin; i < end; i++)
                rows[(i - begin) * n + p] = -t * given_->column[p * stride + i];
        }
    }

    problem *given_;
    int view_;
    const double *fixed_table_;
};

void bound_lobes(const problem *given, double *x, ceres::Problem *target)
{
    target->SetParameterLowerBound(x, 0, 0);
    for (int lobe = 0; lobe < given->lobe_count; lobe++) {
        const int own = 1 + 4 * lobe;
        target->SetParameterLowerBound(x, own, 0);
        for (int k = 1; k <= 2; k++) {
            target->SetParameterLowerBound(x, own + k, -LARGEST_SHAPE);
            target->SetParameterUpperBound(x, own + k, LARGEST_SHAPE);
        }
        target->SetParameterLowerBound(x, own + 3, 0);
        target->SetParameterUpperBound(x, own + 3, std::log(given->max_exponent));
    }
}

std::unique_ptr<ceres::Problem> state_problem(problem *given, solution *result, bool fixed_table)
{
    ceres::Problem::Options options;
    options.disable_all_safety_checks = true;
    auto target = std::make_unique<ceres::Problem>(options);
    for (int view = 0; view < given->view_count; view++) {
        if (given->first[view] == given->first[view + 1])
            continue;
        auto *residuals = new ViewResiduals(given, view, fixed_table ? result->table : nullptr);
        if (fixed_table) {
            target->AddResidualBlock(residuals, nullptr, result->x);
        } else {
            target->AddResidualBlock(residuals, nullptr, result->x, &result->table[view]);
            target->SetParameterLowerBound(&result->table[view], 0, 0);
        }
    }
    bound_lobes(given, result->x, target.get());
    return target;
}

ceres::Solver::Options solver_options(const problem *given)
{
    ceres::Solver::Options options;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.function_tolerance = given->tolerance;
    options.initial_trust_region_radius = FIRST_RADIUS;
    options.max_num_iterations = 100;
    return options;
}

bool solve(const ceres::Solver::Options &options, ceres::Problem *target)
{
    ceres::Solver::Summary summary;
    ceres::Solve(options, target, &summary);
    return summary.IsSolutionUsable();
}

} // namespace

int ceres_alternate(problem *given, double threshold, int max_rounds, solution *result)
{
    try {
        auto target = state_problem(given, result, true);
        ceres::Solver::Options options = solver_options(given);
        options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        for (int round = 0; round < max_rounds; round++) {
            if (!solve(options, target.get()))
                return -1;
            if (!given->fits_table)
                return 0;
            given->code->evaluate(given, result->x, 0, given->sample_count);
            given->passes++;
            if (problem_update_table(given, result->table) < threshold)
                break;
        }
        return 0;
    } catch (...) {
        return -1;
    }
}

int ceres_joint(problem *given, solution *result)
{
    try {
        given->code->evaluate(given, result->x, 0, given->sample_count);
        given->passes++;
        problem_update_table(given, result->table);
        auto target = state_problem(given, result, false);
        ceres::Solver::Options options = solver_options(given);
        options.linear_solver_type = ceres::DENSE_SCHUR;
        auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
        for (int view = 0; view < given->view_count; view++) {
            if (given->first[view] < given->first[view + 1])
                ordering->AddElementToGroup(&result->table[view], 0);
        }
        ordering->AddElementToGroup(result->x, 1);
        options.linear_solver_ordering = ordering;
        return solve(options, target.get()) ? 0 : -1;
    } catch (...) {
        return -1;
    }
}
