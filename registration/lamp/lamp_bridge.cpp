#include "registration/lamp/lamp.h"
#include "registration/lamp/lamp_terms.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace
{

using namespace lamps;

weft_code minimise(owned_problem &terms, weft_error *error)
{
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.num_threads = 2;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-8;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &terms.problem, &summary);
    return summary.IsSolutionUsable()
               ? WEFT_OK
               : weft_fail(error, WEFT_SYSTEM, "the lamps cannot be found: %s", summary.message.c_str());
}

/* As weft_lamp_solve does: the second time with the errors of light under the curve that was found first. */
weft_code find_tone(const weft_lamp_problem *input, double *tone, weft_error *error)
{
    double usual_tone[WEFT_TONE_TERMS] = {};
    std::vector<vec3> ratios((size_t)input->pair_count);
    owned_problem terms;
    std::fill_n(tone, WEFT_TONE_TERMS, 0.0);
    for (int i = 0; i < input->pair_count; i++)
        add_pair(terms, input, input->pair[i], usual_tone, tone, ratios[(size_t)i].data());
    terms.add<3 * WEFT_TONE_TERMS, WEFT_TONE_TERMS>(smooth_residual{}, nullptr, tone);
    for (int round = 0; round < 2; round++) {
        WEFT_TRY(minimise(terms, error));
        std::copy_n(tone, WEFT_TONE_TERMS, usual_tone);
    }
    return WEFT_OK;
}

/* The problem, solved: places, what all photographs share, and how well it is known. */
class lamp_search : lamp_terms
{
  public:
    lamp_search(const weft_lamp_problem *given, weft_lamp_solution *wanted) : lamp_terms(given, wanted), output(wanted)
    {
    }

    weft_code solve(weft_error *error)
    {
        /* The second time the errors are those of light under the curve that was found the first time. */
        for (int round = 0; round < 2; round++) {
            WEFT_TRY(minimise(terms, error));
            std::copy_n(shared.tone, WEFT_TONE_TERMS, usual_tone);
        }
        for (int i = 0; i < input->count; i++)
            write_place(i);
        find_uncertainties();
        write_shared();
        find_misfits();
        find_size();
        return WEFT_OK;
    }

  private:
    weft_lamp_solution *output;

    /* Standard errors of the lamps' directions from the middle of the sample. */
    void find_uncertainties()
    {
        using block_pair = std::pair<const double *, const double *>;
        ceres::Covariance::Options options;
        options.algorithm_type = ceres::SPARSE_QR;
        ceres::Covariance covariance(options);
        std::vector<block_pair> wanted;
        for (int i = 0; i < (input->flash ? 1 : input->count); i++)
            wanted.emplace_back(lamp_of(i), lamp_of(i));
        if (input->tone_unknown)
            wanted.emplace_back(shared.tone, shared.tone);
        wanted.emplace_back(shared.ink, shared.ink);
        const bool known = covariance.Compute(wanted, &terms.problem);
        for (int i = 0; i < input->count; i++)
            output->place[i].uncertainty_deg = known ? uncertainty_deg(covariance, i) : 90;
        if (input->tone_unknown)
            output->dark_error = known ? dark_error(covariance) : 1;
        output->ink_error = known ? ink_error(covariance) : 1;
    }

    double ink_error(const ceres::Covariance &covariance) const
    {
        double matrix[9];
        if (!covariance.GetCovarianceBlock(shared.ink, shared.ink, matrix))
            return 1;
        return std::hypot(std::sqrt(std::max(0.0, matrix[0])), stray_share / std::exp(shared.ink[0]));
    }

    /* Logarithm of the light of an encoded value; `basis`: what each coefficient counts for in it. */
    double log_light(double encoded, double basis[WEFT_TONE_TERMS]) const
    {
        double value = std::log((double)weft_linear_of_srgb((float)encoded)), slope[WEFT_TONE_TERMS];
        weft_tone_basis(encoded, basis, slope);
        for (int k = 0; k < WEFT_TONE_TERMS; k++)
            value += shared.tone[k] * basis[k];
        return value;
    }

    /* Paper in the middle of a photograph's range, and what has a tenth of its light under the curve found. */
    double dark_error(const ceres::Covariance &covariance)
    {
        const double paper = 0.7, step = 1.0 / 1024;
        double matrix[WEFT_TONE_TERMS * WEFT_TONE_TERMS], bright[WEFT_TONE_TERMS], dark[WEFT_TONE_TERMS], variance = 0;
        if (!covariance.GetCovarianceBlock(shared.tone, shared.tone, matrix))
            return 1;
        const double wanted = log_light(paper, bright) - std::log(10);
        for (double encoded = paper; encoded > step && log_light(encoded, dark) > wanted;)
            encoded -= step;
        for (int r = 0; r < WEFT_TONE_TERMS; r++)
            for (int c = 0; c < WEFT_TONE_TERMS; c++)
                variance += (dark[r] - bright[r]) * matrix[r * WEFT_TONE_TERMS + c] * (dark[c] - bright[c]);
        return std::isfinite(variance) ? std::sqrt(std::max(0.0, variance)) : 1;
    }

    /* From the part of the covariance across the direction; of a flash two thirds of it. */
    double uncertainty_deg(const ceres::Covariance &covariance, int i)
    {
        double matrix[9], lamp[3], *block = lamp_of(i), along = 0;
        if (!covariance.GetCovarianceBlock(block, block, matrix))
            return 90;
        mount_of(i).place(block, lamp);
        const double squared = lamp[0] * lamp[0] + lamp[1] * lamp[1] + lamp[2] * lamp[2];
        const double trace = matrix[0] + matrix[4] + matrix[8];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                along += lamp[r] * matrix[3 * r + c] * lamp[c] / squared;
        along = input->flash ? trace / 3 : along;
        return std::hypot(std::sqrt(std::max(0.0, trace - along) / squared), sheet_slope) * 180 / WEFT_PI;
    }

    void write_place(int i)
    {
        double lamp[3];
        mount_of(i).place(lamp_of(i), lamp);
        weft_lamp_place *place = &output->place[i];
        place->position_mm = weft_vec3_of(lamp[0] * unit_mm, lamp[1] * unit_mm, lamp[2] * unit_mm);
        const double beam = input->flash ? mount_of(i).log_beam(lamp_of(i), shared.beam, 0, 0) : 0;
        for (int c = 0; c < 3; c++)
            place->level[c] = std::exp(own[(size_t)i].level[c] + beam) / input->target->paper_reflectance;
        place->residual = paper_residual_of(i);
    }

    /* How far bare paper lies from what the lamp explains: 1.4826 times the median deviation of the logarithm of green
     * light from its median, which is the standard deviation where most of it is free of shadows and stains. */
    double paper_residual_of(int i)
    {
        std::vector<double> off;
        double r[3];
        for (const auto &[residual, photograph] : papers)
            if (photograph == i && (*residual)(lamp_of(i), own[(size_t)i].level, shared.tone, shared.vignetting,
                                               shared.ink, shared.beam, own[(size_t)i].aim, r))
                off.push_back(r[1] / residual->weight);
        const double middle = median(off);
        for (double &value : off)
            value = std::fabs(value - middle);
        return 1.4826 * median(off);
    }

    /* Of balls and pin over what is told, with all else free, once everything else is written. */
    void find_size()
    {
        ceres::Covariance covariance{ceres::Covariance::Options()};
        const std::vector<std::pair<const double *, const double *>> wanted{{&shared.size, &shared.size}};
        double variance;
        output->size = 1, output->size_error = 0;
        if (!terms.problem.HasParameterBlock(&shared.size))
            return;
        terms.problem.SetParameterBlockVariable(&shared.size);
        if (minimise(terms, nullptr) != WEFT_OK)
            return;
        output->size = std::exp(shared.size);
        output->size_error = 1;
        if (covariance.Compute(wanted, &terms.problem) &&
            covariance.GetCovarianceBlock(&shared.size, &shared.size, &variance))
            output->size_error = std::sqrt(std::max(0.0, variance));
    }

    static double median(std::vector<double> &value)
    {
        if (value.empty())
            return 0;
        std::nth_element(value.begin(), value.begin() + (long)value.size() / 2, value.end());
        return value[value.size() / 2];
    }

    /* How many standard errors balls and pin lie off, in the median. */
    void find_misfits()
    {
        std::vector<double> balls, shadows;
        double r[3];
        for (const highlight_seen &seen : highlights)
            balls.push_back((*seen.residual)(lamp_of(seen.photograph), shared.shift[seen.ball], &shared.size, r)
                                ? std::hypot(r[0], r[1], r[2])
                                : HUGE_VAL);
        for (const auto &[residual, i] : pins)
            shadows.push_back((*residual)(lamp_of(i), shared.pin_shift, &shared.size, r) ? std::hypot(r[0], r[1])
                                                                                         : HUGE_VAL);
        output->ball_misfit = median(balls);
        output->pin_misfit = median(shadows);
    }

    void write_shared()
    {
        std::copy_n(shared.tone, WEFT_TONE_TERMS, output->tone);
        const double corner = input->corner_radius_squared;
        output->vignetting[0] = shared.vignetting[0] / corner;
        output->vignetting[1] = shared.vignetting[1] / (corner * corner);
        output->vignetting[2] = 0;
        output->ink = std::exp(shared.ink[0]);
        for (int axis = 0; input->flash && axis < 3; axis++)
            output->flash.place_mm[axis] = shared.flash[axis] * unit_mm;
        if (input->flash)
            std::copy_n(shared.beam, WEFT_BEAM_TERMS, output->flash.beam);
    }
};

} // namespace

extern "C" weft_code weft_tone_of_pairs(const weft_lamp_problem *problem, double tone[WEFT_TONE_TERMS],
                                        weft_error *error)
try {
    return find_tone(problem, tone, error);
} catch (const std::bad_alloc &) {
    return weft_fail_memory(error, "the tone curve", 0);
} catch (const std::exception &failure) {
    return weft_fail(error, WEFT_SYSTEM, "the tone curve: %s", failure.what());
}

extern "C" weft_code weft_lamp_solve(const weft_lamp_problem *problem, weft_lamp_solution *solution, weft_error *error)
try {
    return lamp_search(problem, solution).solve(error);
} catch (const std::bad_alloc &) {
    return weft_fail_memory(error, "the search for lamps", 0);
} catch (const std::exception &failure) {
    return weft_fail(error, WEFT_SYSTEM, "the search for lamps: %s", failure.what());
}