/* A problem of Ceres that loses nothing where memory runs out while a term is put together: Ceres takes only whole
 * terms. For bridges alone. */
#ifndef WEFT_OWNED_PROBLEM_H
#define WEFT_OWNED_PROBLEM_H

#include <ceres/ceres.h>

#include <memory>
#include <vector>

class owned_problem
{
    std::vector<std::unique_ptr<ceres::CostFunction>> costs;
    std::vector<std::unique_ptr<ceres::LossFunction>> losses;

  public:
    ceres::Problem problem{borrowing()};

    /* Adds one term of `residuals` values over blocks of `sizes`; `loss` may be nullptr. Returns the residual, which
     * lives as long as this. Throws std::bad_alloc. */
    template <int residuals, int... sizes, typename residual_type, typename... block>
    const residual_type *add(const residual_type &residual, ceres::LossFunction *loss, block *...blocks)
    {
        auto owned = std::make_unique<residual_type>(residual);
        costs.emplace_back();
        costs.back().reset(new ceres::AutoDiffCostFunction<residual_type, residuals, sizes...>(owned.get()));
        const residual_type *kept = owned.release();
        problem.AddResidualBlock(costs.back().get(), loss, blocks...);
        return kept;
    }

    ceres::LossFunction *cauchy(double width)
    {
        losses.push_back(std::make_unique<ceres::CauchyLoss>(width));
        return losses.back().get();
    }

  private:
    static ceres::Problem::Options borrowing()
    {
        ceres::Problem::Options options;
        options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        return options;
    }
};

#endif
