/* A problem of Ceres that loses nothing where memory runs out while a term is put together: Ceres takes only whole
 * terms. For bridges alone. */
#ifndef WEFT_OWNED_PROBLEM_H
#define WEFT_OWNED_PROBLEM_H

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

/* (value - mean) / deviation of every unknown in a block. */
template <int N> struct prior_residual {
    std::array<double, N> mean, deviation;

    template <typename T> bool operator()(const T *value, T *residual) const
    {
        for (size_t i = 0; i < N; i++)
            residual[i] = (value[i] - mean[i]) / deviation[i];
        return true;
    }
};

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

    /* What is known of a block beforehand: the mean is where it stands now. */
    template <int N> void prior(double *block, const double (&deviation)[N], ceres::LossFunction *loss = nullptr)
    {
        prior_residual<N> known;
        std::copy_n(block, N, known.mean.begin());
        std::copy_n(deviation, N, known.deviation.begin());
        add<N, N>(known, loss, block);
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
