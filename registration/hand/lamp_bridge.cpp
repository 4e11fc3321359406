#include "base/picture/colour.h"
#include "registration/hand/lamp.h"
#include "registration/hand/owned_problem.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace
{

/* Lengths inside the solver, so that all unknowns are of the order of 1. */
constexpr double unit_mm = 100;

/* Standard deviations of the model, not of the noise: paper is no perfect diffuser, and ink shines. */
constexpr double paper_deviation = 0.01, ink_deviation = 0.05;
constexpr double independent_samples = 30;

/* What is known beforehand: lamps stand at some 700 mm, within a factor of e; a ball stands within a millimetre of its
 * place, the head of the pin within half of one; tone curves differ from sRGB by some tens of percent; ink within a
 * fifth. */
constexpr double typical_mm = 700, distance_deviation = 1, shift_deviation_mm = 1, pin_deviation_mm = 0.5;
constexpr double power_deviation = 0.1, ink_prior_deviation = 0.2, vignetting_deviation = 0.2, flash_deviation_mm = 60;

/* Beams of flashes lie between that of a bare tube, cos^0, and one that leaves a stop less in the corners of a wide
 * lens, cos^4; a beam of cos^2 may be turned aside by six degrees. */
constexpr double beam_mean[WEFT_BEAM_TERMS] = {0, 0, -1, 0, -1}, beam_deviation[WEFT_BEAM_TERMS] = {0.2, 0.2, 1, 1, 1};

constexpr double tone_deviation[WEFT_TONE_TERMS] = {0.5, 0.5, 0.25, 0.25, 0.125};

using vec3 = std::array<double, 3>;

/* Unknowns of one photograph: the lamp in units, and the logarithm of its level in three channels. */
struct photograph_unknowns {
    double lamp[3], level[3];
};

/* Unknowns that all photographs share. */
struct shared_unknowns {
    double tone[WEFT_TONE_TERMS], vignetting[2], ink, power, shift[WEFT_TARGET_BALL_COUNT][2], pin_shift[3], flash[3],
        beam[WEFT_BEAM_TERMS];
};

/* From the lamp's unknowns to its place on the plate: itself, or moved with the camera. */
struct mounting {
    bool is_flash;
    weft_pose pose;

    template <typename T> void place(const T *unknown, T *lamp) const
    {
        if (!is_flash) {
            std::copy_n(unknown, 3, lamp);
            return;
        }
        T there[3] = {unknown[0] - pose.translation.x / unit_mm, unknown[1] - pose.translation.y / unit_mm,
                      unknown[2] - pose.translation.z / unit_mm};
        for (int axis = 0; axis < 3; axis++)
            lamp[axis] = pose.rotation[0][axis] * there[0] + pose.rotation[1][axis] * there[1] +
                         pose.rotation[2][axis] * there[2];
    }

    /* Logarithm of the beam of a flash towards a place of the plate: weft_flash_log_beam. */
    template <typename T> T log_beam(const T *unknown, const T *beam, double x, double y) const
    {
        const double from[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
        T to[3];
        for (int axis = 0; axis < 3; axis++)
            to[axis] = pose.rotation[axis][0] * x + pose.rotation[axis][1] * y + from[axis] / unit_mm - unknown[axis];
        const T u = to[0] / to[2], v = to[1] / to[2];
        return u * (beam[0] + beam[2] * u + beam[3] * v) + v * (beam[1] + beam[4] * v);
    }
};

struct paper_residual {
    mounting mount;
    double x, y, log_light[3], power[3][WEFT_TONE_TERMS], radius_squared, weight;
    bool is_ink;

    template <typename T>
    bool operator()(const T *unknown, const T *level, const T *tone, const T *vignetting, const T *ink, const T *beam,
                    T *residual) const
    {
        T lamp[3];
        mount.place(unknown, lamp);
        if (lamp[2] <= T(0.01))
            return false;
        const T dx = lamp[0] - x, dy = lamp[1] - y;
        const T near_squared = dx * dx + dy * dy + lamp[2] * lamp[2];
        const T far_squared = lamp[0] * lamp[0] + lamp[1] * lamp[1] + lamp[2] * lamp[2];
        const T fall = 1.0 + radius_squared * (vignetting[0] + radius_squared * vignetting[1]);
        if (fall <= T(0.05))
            return false;
        T common = log(lamp[2]) + log(far_squared) - 1.5 * log(near_squared) + log(fall);
        if (is_ink)
            common += ink[0];
        if (mount.is_flash)
            common += mount.log_beam(unknown, beam, x, y);
        for (int c = 0; c < 3; c++) {
            T value = T(log_light[c]);
            for (int k = 0; k < WEFT_TONE_TERMS; k++)
                value += tone[k] * power[c][k];
            residual[c] = weight * (value - level[c] - common);
        }
        return true;
    }
};

struct highlight_residual {
    mounting mount;
    vec3 eye, ray, touch; /* in units; `touch` is where the ball touches the sheet by the drawing */
    double radius, deviation_rad;

    template <typename T> bool operator()(const T *unknown, const T *shift, T *residual) const
    {
        const T centre[3] = {touch[0] + shift[0], touch[1] + shift[1], T(radius)};
        T offset[3], half = T(0), square = T(0);
        for (int i = 0; i < 3; i++) {
            offset[i] = eye[i] - centre[i];
            half += offset[i] * ray[i];
            square += offset[i] * offset[i];
        }
        const T under = half * half - square + radius * radius;
        if (under <= T(1e-9)) /* the ray passes the ball */
            return false;
        const T along = -half - sqrt(under);
        T point[3], lamp[3], normal_part = T(0), normal[3], to[3], length = T(0);
        mount.place(unknown, lamp);
        for (int i = 0; i < 3; i++) {
            point[i] = eye[i] + ray[i] * along;
            normal[i] = (point[i] - centre[i]) / radius;
            normal_part += ray[i] * normal[i];
            to[i] = lamp[i] - point[i];
            length += to[i] * to[i];
        }
        length = sqrt(length);
        T mirrored[3];
        for (int i = 0; i < 3; i++)
            mirrored[i] = ray[i] - 2.0 * normal_part * normal[i];
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            residual[i] = (to[j] * mirrored[k] - to[k] * mirrored[j]) / (length * deviation_rad);
        }
        return true;
    }
};

/* The shadow of the pin's head: where the ray from the lamp through the head meets the sheet. Along the shadow and
 * across it, which errs less. */
struct pin_residual {
    mounting mount;
    vec3 head; /* by the drawing */
    double shadow[2], along[2], along_deviation, across_deviation;

    template <typename T> bool operator()(const T *unknown, const T *shift, T *residual) const
    {
        T lamp[3], off[2];
        mount.place(unknown, lamp);
        const T height = head[2] + shift[2], above = lamp[2] - height;
        if (above <= T(0.05))
            return false;
        for (int axis = 0; axis < 2; axis++) {
            const T at = head[(size_t)axis] + shift[axis];
            off[axis] = at + (at - lamp[axis]) * height / above - shadow[axis];
        }
        residual[0] = (off[0] * along[0] + off[1] * along[1]) / along_deviation;
        residual[1] = (off[1] * along[0] - off[0] * along[1]) / across_deviation;
        return true;
    }
};

/* What a list says: a direction across itself, or a place, whose distance errs as its direction does. */
struct listed_residual {
    mounting mount;
    vec3 light;
    bool is_position;
    double deviation_rad;

    template <typename T> bool operator()(const T *unknown, T *residual) const
    {
        T lamp[3], length = T(0);
        mount.place(unknown, lamp);
        for (int i = 0; i < 3; i++)
            length += lamp[i] * lamp[i];
        length = sqrt(length);
        const double listed = std::sqrt(light[0] * light[0] + light[1] * light[1] + light[2] * light[2]);
        for (size_t i = 0; i < 3; i++) {
            const size_t j = (i + 1) % 3, k = (i + 2) % 3;
            residual[i] = (lamp[j] * light[k] - lamp[k] * light[j]) / (length * listed * deviation_rad);
        }
        residual[3] = is_position ? log(length / listed) / deviation_rad : T(0);
        return true;
    }
};

/* The power of the lamp: the level times the squared distance, for the exposure. */
struct power_residual {
    mounting mount;
    double log_exposure;

    template <typename T> bool operator()(const T *unknown, const T *level, const T *power, T *residual) const
    {
        T lamp[3];
        mount.place(unknown, lamp);
        const T squared = lamp[0] * lamp[0] + lamp[1] * lamp[1] + lamp[2] * lamp[2];
        residual[0] = (level[1] + log(squared) - log_exposure - power[0]) / power_deviation;
        return true;
    }
};

/* Tone curves are smooth: the higher a power, the less of it. */
struct tone_residual {
    template <typename T> bool operator()(const T *tone, T *residual) const
    {
        for (int k = 0; k < WEFT_TONE_TERMS; k++)
            residual[k] = tone[k] / tone_deviation[k];
        return true;
    }
};

struct beam_residual {
    template <typename T> bool operator()(const T *beam, T *residual) const
    {
        for (int k = 0; k < WEFT_BEAM_TERMS; k++)
            residual[k] = (beam[k] - beam_mean[k]) / beam_deviation[k];
        return true;
    }
};

/* (value - mean) / deviation of every unknown in a block. */
template <int N> struct prior_residual {
    std::array<double, N> mean;
    double deviation;

    template <typename T> bool operator()(const T *value, T *residual) const
    {
        for (int i = 0; i < N; i++)
            residual[i] = (value[i] - mean[i]) / deviation;
        return true;
    }
};

struct distance_residual {
    template <typename T> bool operator()(const T *lamp, T *residual) const
    {
        const T squared = lamp[0] * lamp[0] + lamp[1] * lamp[1] + lamp[2] * lamp[2];
        residual[0] = (0.5 * log(squared) - std::log(typical_mm / unit_mm)) / distance_deviation;
        return true;
    }
};

/* The mean is where the block stands now. */
template <int N> void add_prior(owned_problem &terms, double *block, double deviation)
{
    std::array<double, N> mean;
    std::copy_n(block, N, mean.begin());
    terms.add<N, N>(prior_residual<N>{mean, deviation}, nullptr, block);
}

class lamp_search
{
  public:
    lamp_search(const weft_lamp_problem *given, weft_lamp_solution *wanted)
        : input(given), output(wanted), own((size_t)given->count)
    {
        shared = {};
        shared.ink = std::log(wanted->ink);
        if (input->flash)
            std::copy_n(beam_mean, WEFT_BEAM_TERMS, shared.beam);
        for (int i = 0; i < input->count; i++)
            start(i);
        for (int i = 0; i < input->count; i++) {
            add_paper(i);
            add_highlights(i);
            add_pin(i);
            add_listed(i);
        }
        add_power();
        add_priors();
    }

    weft_code solve(weft_error *error)
    {
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
        options.num_threads = 2;
        options.max_num_iterations = 200;
        options.function_tolerance = 1e-9;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &terms.problem, &summary);
        if (!summary.IsSolutionUsable())
            return weft_fail(error, WEFT_SYSTEM, "the lamps cannot be found: %s", summary.message.c_str());
        for (int i = 0; i < input->count; i++)
            write_place(i);
        find_uncertainties();
        write_shared();
        find_misfits();
        return WEFT_OK;
    }

  private:
    const weft_lamp_problem *input;
    weft_lamp_solution *output;
    std::vector<photograph_unknowns> own;
    shared_unknowns shared;
    owned_problem terms;

    struct highlight_seen {
        const highlight_residual *residual; /* of the problem */
        int photograph, ball;
    };
    std::vector<highlight_seen> highlights;
    std::vector<std::pair<const pin_residual *, int>> pins;

    double *lamp_of(int i)
    {
        return input->flash ? shared.flash : own[(size_t)i].lamp;
    }

    mounting mount_of(int i) const
    {
        return {input->flash, input->evidence[i].pose};
    }

    /* The level that the guess of the lamp leaves at the median. */
    void start(int i)
    {
        const weft_lamp_evidence &evidence = input->evidence[i];
        const weft_vec3 lamp = output->place[i].position_mm;
        const double squared = (double)weft_dot(lamp, lamp);
        photograph_unknowns &unknowns = own[(size_t)i];
        unknowns = {{lamp.x / unit_mm, lamp.y / unit_mm, lamp.z / unit_mm}, {0, 0, 0}};
        for (int c = 0; c < 3; c++) {
            std::vector<double> level;
            for (int k = 0; k < evidence.paper.count; k++) {
                const weft_paper_sample &s = evidence.paper.sample[k];
                const double *at = input->places->place[s.place];
                const double dx = lamp.x - at[0], dy = lamp.y - at[1], near = dx * dx + dy * dy + lamp.z * lamp.z;
                if (!input->places->is_ink[s.place] && s.light[c] > 0)
                    level.push_back(std::log((double)s.light[c]) - std::log(lamp.z * squared) + 1.5 * std::log(near));
            }
            if (level.empty())
                continue;
            std::nth_element(level.begin(), level.begin() + (long)level.size() / 2, level.end());
            unknowns.level[c] = level[level.size() / 2];
        }
    }

    void add_paper(int i)
    {
        const weft_paper_samples &paper = input->evidence[i].paper;
        const double share = std::sqrt(std::min(1.0, independent_samples / std::max(1, 3 * paper.count)));
        for (int k = 0; k < paper.count; k++) {
            const weft_paper_sample &s = paper.sample[k];
            const bool is_ink = input->places->is_ink[s.place];
            paper_residual residual = {};
            residual.mount = mount_of(i);
            residual.x = input->places->place[s.place][0] / unit_mm;
            residual.y = input->places->place[s.place][1] / unit_mm;
            residual.radius_squared = (double)s.radius_squared / input->corner_radius_squared;
            residual.is_ink = is_ink;
            residual.weight = share / (is_ink ? ink_deviation : paper_deviation);
            if (!(std::min({s.light[0], s.light[1], s.light[2]}) > 1e-4f))
                continue;
            for (int c = 0; c < 3; c++) {
                residual.log_light[c] = std::log((double)s.light[c]);
                double power = 1, encoded = 2 * (double)weft_srgb_of_linear(s.light[c]) - 1;
                for (int term = 0; term < WEFT_TONE_TERMS; term++)
                    residual.power[c][term] = power *= encoded;
            }
            terms.add<3, 3, 3, WEFT_TONE_TERMS, 2, 1, WEFT_BEAM_TERMS>(residual, terms.cauchy(3 * share), lamp_of(i),
                                                                       own[(size_t)i].level, shared.tone,
                                                                       shared.vignetting, &shared.ink, shared.beam);
        }
    }

    void add_highlights(int i)
    {
        const weft_lamp_evidence &evidence = input->evidence[i];
        const weft_vec3 eye = weft_pose_camera_position(&evidence.pose);
        for (int ball = 0; ball < WEFT_TARGET_BALL_COUNT; ball++) {
            const weft_highlight &seen = evidence.highlight[ball];
            if (!seen.found || !(input->ball_diameter_mm > 0))
                continue;
            double place[2];
            weft_target_ball(input->target, ball, place);
            const highlight_residual residual = {mount_of(i),
                                                 {eye.x / unit_mm, eye.y / unit_mm, eye.z / unit_mm},
                                                 {seen.ray.x, seen.ray.y, seen.ray.z},
                                                 {place[0] / unit_mm, place[1] / unit_mm, 0},
                                                 input->ball_diameter_mm / 2 / unit_mm,
                                                 seen.deviation_rad};
            double vanishing[3];
            if (!residual(lamp_of(i), shared.shift[ball], vanishing))
                continue;
            highlights.push_back(
                {terms.add<3, 3, 2>(residual, terms.cauchy(3), lamp_of(i), shared.shift[ball]), i, ball});
        }
    }

    void add_pin(int i)
    {
        const weft_pin_shadow &seen = input->evidence[i].pin;
        if (!seen.found || !(input->pin_height_mm > 0))
            return;
        double foot[2];
        weft_target_pin(input->target, foot);
        const double ux = seen.place[0] - foot[0], uy = seen.place[1] - foot[1], length = std::hypot(ux, uy);
        const pin_residual residual = {
            mount_of(i),
            {foot[0] / unit_mm, foot[1] / unit_mm, (input->pin_height_mm - weft_pin_head_radius_mm) / unit_mm},
            {seen.place[0] / unit_mm, seen.place[1] / unit_mm},
            {ux / length, uy / length},
            seen.along_mm / unit_mm,
            seen.across_mm / unit_mm};
        pins.emplace_back(terms.add<2, 3, 3>(residual, terms.cauchy(3), lamp_of(i), shared.pin_shift), i);
    }

    void add_listed(int i)
    {
        const weft_listed_lamp &listed = input->evidence[i].listed;
        const double scale = listed.is_position ? 1 / unit_mm : 1;
        if (listed.found)
            terms.add<4, 3>(listed_residual{mount_of(i),
                                            {listed.light.x * scale, listed.light.y * scale, listed.light.z * scale},
                                            listed.is_position,
                                            listed.deviation_rad},
                            terms.cauchy(3), lamp_of(i));
    }

    double log_power(int i) const
    {
        const weft_vec3 lamp = output->place[i].position_mm;
        const double squared = (double)weft_dot(lamp, lamp) / (unit_mm * unit_mm);
        return own[(size_t)i].level[1] + std::log(squared) - std::log(input->evidence[i].exposure);
    }

    /* One lamp has one power; it begins at the median. */
    void add_power()
    {
        std::vector<double> power;
        for (int i = 0; i < input->count; i++)
            if (input->evidence[i].exposure > 0)
                power.push_back(log_power(i));
        if (power.size() < 2)
            return;
        std::nth_element(power.begin(), power.begin() + (long)power.size() / 2, power.end());
        shared.power = power[power.size() / 2];
        for (int i = 0; i < input->count; i++) {
            if (!(input->evidence[i].exposure > 0))
                continue;
            terms.add<1, 3, 3, 1>(power_residual{mount_of(i), std::log(input->evidence[i].exposure)}, terms.cauchy(2),
                                  lamp_of(i), own[(size_t)i].level, &shared.power);
        }
    }

    void hold(double *block)
    {
        if (terms.problem.HasParameterBlock(block))
            terms.problem.SetParameterBlockConstant(block);
    }

    void add_priors()
    {
        terms.add<WEFT_TONE_TERMS, WEFT_TONE_TERMS>(tone_residual{}, nullptr, shared.tone);
        /* Natural vignetting is cos^4 = 1 - 2 r^2 + ...; the rims of a lens take more, its design less. */
        shared.vignetting[0] = -2 * input->corner_radius_squared;
        add_prior<2>(terms, shared.vignetting, vignetting_deviation);
        add_prior<1>(terms, &shared.ink, ink_prior_deviation);
        for (auto &shift : shared.shift)
            add_prior<2>(terms, shift, shift_deviation_mm / unit_mm);
        add_prior<3>(terms, shared.pin_shift, pin_deviation_mm / unit_mm);
        add_flash_priors();
        for (int i = 0; !input->flash && i < input->count; i++)
            terms.add<1, 3>(distance_residual{}, nullptr, lamp_of(i));
        if (!input->tone_unknown)
            hold(shared.tone);
    }

    void add_flash_priors()
    {
        terms.add<WEFT_BEAM_TERMS, WEFT_BEAM_TERMS>(beam_residual{}, nullptr, shared.beam);
        if (input->flash)
            add_prior<3>(terms, shared.flash, flash_deviation_mm / unit_mm);
        else
            hold(shared.beam);
    }

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
        const bool known = covariance.Compute(wanted, &terms.problem);
        for (int i = 0; i < input->count; i++)
            output->place[i].uncertainty_deg = known ? uncertainty_deg(covariance, i) : 90;
        if (input->tone_unknown)
            output->dark_error = known ? dark_error(covariance) : 1;
    }

    /* (2 encoded - 1)^k of an encoded value; returns the logarithm of its light. */
    double tone_powers(double encoded, double power[WEFT_TONE_TERMS]) const
    {
        double value = std::log((double)weft_linear_of_srgb((float)encoded)), stretched = 1;
        for (int k = 0; k < WEFT_TONE_TERMS; k++)
            value += shared.tone[k] * (power[k] = stretched *= 2 * encoded - 1);
        return value;
    }

    /* Paper in the middle of a photograph's range, and what has a tenth of its light under the curve found. */
    double dark_error(const ceres::Covariance &covariance)
    {
        const double paper = 0.7, step = 1.0 / 1024;
        double matrix[WEFT_TONE_TERMS * WEFT_TONE_TERMS], bright[WEFT_TONE_TERMS], dark[WEFT_TONE_TERMS], variance = 0;
        if (!covariance.GetCovarianceBlock(shared.tone, shared.tone, matrix))
            return 1;
        const double wanted = tone_powers(paper, bright) - std::log(10);
        for (double encoded = paper; encoded > step && tone_powers(encoded, dark) > wanted;)
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
        return std::sqrt(std::max(0.0, trace - along) / squared) * 180 / WEFT_PI;
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
            balls.push_back((*seen.residual)(lamp_of(seen.photograph), shared.shift[seen.ball], r)
                                ? std::hypot(r[0], r[1], r[2])
                                : HUGE_VAL);
        for (const auto &[residual, i] : pins)
            shadows.push_back((*residual)(lamp_of(i), shared.pin_shift, r) ? std::hypot(r[0], r[1]) : HUGE_VAL);
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
        output->ink = std::exp(shared.ink);
        for (int ball = 0; ball < WEFT_TARGET_BALL_COUNT; ball++)
            for (int axis = 0; axis < 2; axis++)
                output->ball_shift_mm[ball][axis] = shared.shift[ball][axis] * unit_mm;
        for (int axis = 0; axis < 3; axis++)
            output->pin_shift_mm[axis] = shared.pin_shift[axis] * unit_mm;
        for (int axis = 0; axis < 3; axis++)
            output->flash.place_mm[axis] = shared.flash[axis] * unit_mm;
        std::copy_n(shared.beam, WEFT_BEAM_TERMS, output->flash.beam);
    }
};

} // namespace

extern "C" weft_code weft_lamp_solve(const weft_lamp_problem *problem, weft_lamp_solution *solution, weft_error *error)
try {
    return lamp_search(problem, solution).solve(error);
} catch (const std::bad_alloc &) {
    return weft_fail_memory(error, "the search for lamps", 0);
} catch (const std::exception &failure) {
    return weft_fail(error, WEFT_SYSTEM, "the search for lamps: %s", failure.what());
}
