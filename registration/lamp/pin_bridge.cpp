#include "registration/lamp/evidence.h"
#include "registration/lamp/owned_problem.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace
{

/* Half the width of the pin; softness of the sharpest edge, which pixels make; how far around the shadow is looked at.
 */
constexpr double pin_radius = 0.4, least_softness = 0.25, around_mm = 4, beyond_mm = 5, foot_mm = 1.2;

/* What is known beforehand: the pin stands within a millimetre of its place. */
constexpr double foot_deviation_mm = 0.7, end_deviation_mm = 3;

/* Unlike noise, what the model lacks is alike in neighbours: so many texels count as one. */
constexpr double texels_alike = 6;

/* What does not show in the residuals: a bent pin, a warp that is off. */
constexpr double least_error_mm = 0.1, penumbra_share = 0.15;

template <typename T> T step(const T &distance, const T &softness)
{
    using std::erf;
    return 0.5 - 0.5 * erf(distance / (softness * std::sqrt(2.0)));
}

/* Of one texel. The parameters: end of the shadow, foot, and softness at the end, darkness and what is beside. */
struct texel_residual {
    double x, y, darkness, height;
    bool is_open; /* the shadow has no end */

    template <typename T> bool operator()(const T *end, const T *foot, const T *shape, T *residual) const
    {
        using std::sqrt;
        const T ux = end[0] - foot[0], uy = end[1] - foot[1], length = sqrt(ux * ux + uy * uy + 1e-6);
        const T along = ((x - foot[0]) * ux + (y - foot[1]) * uy) / length;
        const T across = ((y - foot[1]) * ux - (x - foot[0]) * uy) / length;
        const T part = along / length, lean = sqrt(1.0 + length * length / (height * height));
        const T grown = shape[0] * (part > 1.0 ? T(1) : part);
        const T softness = sqrt(grown * grown + least_softness * least_softness);
        const T at_end = sqrt(shape[0] * shape[0] + least_softness * least_softness);
        const T past = (along - length) / lean;
        const T whole = step(across - pin_radius, softness) - step(across + pin_radius, softness);
        if (is_open) {
            residual[0] = shape[2] + shape[1] * whole - darkness;
            return true;
        }
        const T line = whole * step(past, at_end);
        const T ring = sqrt(past * past + across * across + 1e-6) - weft_pin_head_radius_mm;
        const T shaded = 1.0 - (1.0 - line) * (1.0 - step(ring, at_end));
        residual[0] = shape[2] + shape[1] * shaded - darkness;
        return true;
    }
};

class shadow_fit
{
  public:
    shadow_fit(const weft_pin_area *where, const float *values, weft_pin_shadow *wanted)
        : area(where), darkness(values), shadow(wanted), is_open(std::isinf(wanted->along_mm))
    {
        std::copy_n(shadow->place, 2, end);
        std::copy_n(area->foot, 2, foot);
        for (int i = 0; i < area->columns * area->rows; i++)
            add(i);
        hold_near(foot, foot_deviation_mm);
        if (is_open) /* nothing else says where along the line it is */
            hold_near(end, end_deviation_mm);
    }

    void solve()
    {
        shadow->found = false;
        if (texels < fewest_texels)
            return;
        terms.problem.SetParameterLowerBound(shape, 0, 0.02);
        terms.problem.SetParameterUpperBound(shape, 0, 4);
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.max_num_iterations = 40;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &terms.problem, &summary);
        const double moved = std::hypot(end[0] - shadow->place[0], end[1] - shadow->place[1]);
        if (!summary.IsSolutionUsable() || !(moved < farthest_mm) || !(shape[1] > least_darkness) || !(shape[0] < 3))
            return;
        std::copy_n(end, 2, shadow->place);
        shadow->found = find_errors(std::sqrt(2 * summary.final_cost / texels));
    }

  private:
    static constexpr int fewest_texels = 200;
    static constexpr double noise = 0.03, strange_darkness = 0.25, farthest_mm = 4, least_darkness = 0.25;
    const weft_pin_area *area;
    const float *darkness;
    weft_pin_shadow *shadow;
    double end[2], foot[2], shape[3] = {0.3, 0.7, 0};
    bool is_open;
    int texels = 0;
    owned_problem terms;

    void hold_near(double *place, double deviation_mm)
    {
        const double deviation = deviation_mm / (noise * std::sqrt(texels_alike));
        terms.prior<2>(place, {deviation, deviation});
    }

    void add(int i)
    {
        const double x = area->x0 + area->step_mm * (i % area->columns);
        const double y = area->y0 + area->step_mm * (int)(i / area->columns);
        const double ux = end[0] - foot[0], uy = end[1] - foot[1], length = std::hypot(ux, uy);
        const double along = ((x - foot[0]) * ux + (y - foot[1]) * uy) / length;
        const double across = ((y - foot[1]) * ux - (x - foot[0]) * uy) / length;
        if (!(along > foot_mm && along < length + beyond_mm && std::fabs(across) < around_mm) ||
            !std::isfinite(darkness[i]))
            return;
        texels++;
        terms.add<1, 2, 2, 3>(texel_residual{x, y, (double)darkness[i], area->height_mm, is_open},
                              terms.cauchy(strange_darkness), end, foot, shape);
    }

    /* From the covariance for residuals of 1, along the shadow and across it. */
    bool find_errors(double deviation)
    {
        ceres::Covariance covariance((ceres::Covariance::Options()));
        double c[4];
        const std::vector<std::pair<const double *, const double *>> wanted = {{end, end}};
        if (!covariance.Compute(wanted, &terms.problem) || !covariance.GetCovarianceBlock(end, end, c))
            return false;
        const double ux = end[0] - foot[0], uy = end[1] - foot[1], squared = ux * ux + uy * uy;
        const double along = (ux * ux * c[0] + 2 * ux * uy * c[1] + uy * uy * c[3]) / squared;
        const double across = (uy * uy * c[0] - 2 * ux * uy * c[1] + ux * ux * c[3]) / squared;
        const double lean = std::sqrt(1 + squared / (area->height_mm * area->height_mm));
        const double floor = std::hypot(least_error_mm, penumbra_share * shape[0]);
        deviation = std::max(deviation, noise) * std::sqrt(texels_alike);
        shadow->along_mm = is_open ? INFINITY : std::hypot(deviation * std::sqrt(std::max(0.0, along)), floor * lean);
        shadow->across_mm = std::hypot(deviation * std::sqrt(std::max(0.0, across)), floor);
        return true;
    }
};

} // namespace

extern "C" weft_code weft_pin_refine(const weft_pin_area *area, const float *darkness, weft_pin_shadow *shadow,
                                     weft_error *error)
try {
    shadow_fit(area, darkness, shadow).solve();
    return WEFT_OK;
} catch (const std::bad_alloc &) {
    return weft_fail_memory(error, "the shadow of the pin", 0);
} catch (const std::exception &failure) {
    return weft_fail(error, WEFT_SYSTEM, "the shadow of the pin: %s", failure.what());
}
