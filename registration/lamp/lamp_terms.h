/* The problem of the search for lamps: its unknowns, and a term for all that is seen and known. For the bridge alone.
 */
#ifndef WEFT_REGISTRATION_LAMP_LAMP_TERMS_H
#define WEFT_REGISTRATION_LAMP_LAMP_TERMS_H

#include "base/picture/colour.h"
#include "registration/lamp/lamp_laws.h"
#include "registration/lamp/owned_problem.h"

#include <utility>

namespace lamps
{

/* Unknowns of one photograph: the lamp in units, the logarithm of its level in three channels, and the place of the
 * plate that it is held towards. */
struct photograph_unknowns {
    double lamp[3], level[3], aim[2];
};

/* Unknowns that all photographs share. Of ink: logarithm of its reflectance over that of paper, shine, and the
 * logarithm of its width. Of the beam of a lamp that is not fixed to the camera: the power alone. */
struct shared_unknowns {
    double tone[WEFT_TONE_TERMS], vignetting[2], ink[3], power, size, shift[WEFT_TARGET_BALL_COUNT][2], pin_shift[3],
        flash[3], beam[WEFT_BEAM_TERMS];
};

/* Of light that is decoded as sRGB. */
inline toned_value toned(float light)
{
    toned_value value;
    const double encoded = (double)weft_srgb_of_linear(light), step = 0.01 * encoded;
    const double rise = std::log((double)weft_linear_of_srgb((float)(encoded + step)) /
                                 (double)weft_linear_of_srgb((float)(encoded - step))) /
                        (2 * step);
    weft_tone_basis(encoded, value.basis, value.rise_basis);
    for (double &basis : value.rise_basis)
        basis /= rise;
    value.log_light = std::log((double)light);
    return value;
}

/* The logarithms of light that both photographs of a pair have at a place. Samples are in the order of
 * places. */
inline void add_pair(owned_problem &terms, const weft_lamp_problem *input, const weft_exposure_pair &pair,
                     const double *usual_tone, double *tone, double *ratio)
{
    const weft_paper_samples &bright = input->evidence[pair.bright].paper, &dark = input->evidence[pair.dark].paper;
    const double share = std::sqrt(independent_pair_samples / (3 * std::max(bright.count, dark.count)));
    std::fill_n(ratio, 3, pair.log_ratio);
    for (int i = 0, k = 0; i < bright.count && k < dark.count;) {
        const weft_paper_sample &a = bright.sample[i], &b = dark.sample[k];
        i += a.place <= b.place;
        k += b.place <= a.place;
        if (a.place != b.place)
            continue;
        pair_residual residual = {};
        residual.usual_tone = usual_tone;
        for (int c = 0; c < 3; c++) {
            const double rounding = rounding_deviation / (double)weft_srgb_of_linear(b.light[c]);
            residual.weight[c] = std::min(1.0, share) / std::hypot(pair_deviation, rounding);
            residual.bright[c] = toned(a.light[c]);
            residual.dark[c] = toned(b.light[c]);
        }
        terms.add<3, WEFT_TONE_TERMS, 3>(residual, terms.cauchy(3 * share), tone, ratio);
    }
    /* As the camera wrote it. The white balance may change, so it holds for green. */
    terms.prior<3>(ratio, {HUGE_VAL, ratio_deviation, HUGE_VAL}, terms.cauchy(2));
}

class lamp_terms
{
  public:
    /* `guess` gives places and ink, where the search starts. */
    lamp_terms(const weft_lamp_problem *given, const weft_lamp_solution *guess)
        : input(given), own((size_t)given->count), ratios((size_t)given->pair_count)
    {
        const double ink_known[3] = {std::log(input->target->ink_reflectance / input->target->paper_reflectance),
                                     shine_mean, std::log(shine_width)};
        std::copy_n(ink_known, 3, shared.ink);
        std::copy_n(guess->tone, WEFT_TONE_TERMS, shared.tone);
        std::copy_n(guess->tone, WEFT_TONE_TERMS, usual_tone);
        if (input->flash)
            std::copy_n(beam_mean, WEFT_BEAM_TERMS, shared.beam);
        else
            shared.beam[0] = beam_power_mean;
        for (int i = 0; i < input->count; i++)
            start(i, guess->place[i].position_mm);
        for (int i = 0; i < input->count; i++) {
            add_paper(i);
            add_highlights(i);
            add_pin(i);
            add_listed(i);
        }
        add_power(guess);
        for (int i = 0; input->tone_unknown && i < input->pair_count; i++)
            add_pair(terms, input, input->pair[i], usual_tone, shared.tone, ratios[(size_t)i].data());
        add_priors();
    }

  protected:
    const weft_lamp_problem *input;
    double usual_tone[WEFT_TONE_TERMS] = {}; /* whose rise makes errors of values those of light */
    std::vector<photograph_unknowns> own;
    std::vector<vec3> ratios; /* of exposures: logarithms in three channels */
    shared_unknowns shared = {};
    owned_problem terms;

    struct highlight_seen {
        const highlight_residual *residual; /* of the problem */
        int photograph, ball;
    };
    std::vector<highlight_seen> highlights;
    std::vector<std::pair<const paper_residual *, int>> papers; /* bare ones, and the photograph of each */
    std::vector<std::pair<const pin_residual *, int>> pins;

    double *lamp_of(int i)
    {
        return input->flash ? shared.flash : own[(size_t)i].lamp;
    }

    /* Of the sheet. */
    double height_at(const double place[2]) const
    {
        return weft_bend_height(&input->bend, place[0], place[1]) / unit_mm;
    }

    mounting mount_of(int i) const
    {
        return {input->flash, input->evidence[i].pose};
    }

  private:
    /* The level that the guess of the lamp leaves at the median. */
    void start(int i, weft_vec3 lamp)
    {
        const weft_lamp_evidence &evidence = input->evidence[i];
        const double squared = (double)weft_dot(lamp, lamp);
        photograph_unknowns &unknowns = own[(size_t)i];
        unknowns = {{lamp.x / unit_mm, lamp.y / unit_mm, lamp.z / unit_mm}, {0, 0, 0}, {0, 0}};
        for (int c = 0; c < 3; c++) {
            std::vector<double> level;
            for (int k = 0; k < evidence.paper.count; k++) {
                const weft_paper_sample &s = evidence.paper.sample[k];
                const double *at = input->places->place[s.place];
                const double dx = lamp.x - at[0], dy = lamp.y - at[1], near = dx * dx + dy * dy + lamp.z * lamp.z;
                if (!input->places->is_ink[s.place] && s.light[c] > 0)
                    level.push_back(toned(s.light[c]).log_of(shared.tone) - std::log(lamp.z * squared) +
                                    1.5 * std::log(near));
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
        const weft_vec3 camera = weft_pose_camera_position(&input->evidence[i].pose);
        const vec3 eye = {camera.x / unit_mm, camera.y / unit_mm, camera.z / unit_mm};
        for (int k = 0; k < paper.count; k++) {
            const weft_paper_sample &s = paper.sample[k];
            const bool is_ink = input->places->is_ink[s.place];
            paper_residual residual = {};
            residual.mount = mount_of(i);
            residual.x = input->places->place[s.place][0] / unit_mm;
            residual.y = input->places->place[s.place][1] / unit_mm;
            residual.z = height_at(input->places->place[s.place]);
            const weft_vec3 normal =
                weft_bend_normal(&input->bend, input->places->place[s.place][0], input->places->place[s.place][1]);
            residual.normal[0] = normal.x / normal.z;
            residual.normal[1] = normal.y / normal.z;
            residual.radius_squared = (double)s.radius_squared / input->corner_radius_squared;
            residual.is_ink = is_ink;
            residual.weight = share / (is_ink ? ink_deviation : paper_deviation);
            residual.eye = eye;
            residual.usual_tone = usual_tone;
            for (int c = 0; c < 3; c++)
                residual.value[c] = toned(s.light[c]);
            const auto *kept = terms.add<3, 3, 3, WEFT_TONE_TERMS, 2, 3, WEFT_BEAM_TERMS, 2>(
                residual, terms.cauchy(3 * share), lamp_of(i), own[(size_t)i].level, shared.tone, shared.vignetting,
                shared.ink, shared.beam, own[(size_t)i].aim);
            if (!is_ink)
                papers.emplace_back(kept, i);
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
                                                 {place[0] / unit_mm, place[1] / unit_mm, height_at(place)},
                                                 input->ball_diameter_mm / 2 / unit_mm,
                                                 seen.deviation_rad};
            double vanishing[3];
            if (!residual(lamp_of(i), shared.shift[ball], &shared.size, vanishing))
                continue;
            highlights.push_back(
                {terms.add<3, 3, 2, 1>(residual, terms.cauchy(3), lamp_of(i), shared.shift[ball], &shared.size), i,
                 ball});
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
            height_at(foot),
            {seen.place[0] / unit_mm, seen.place[1] / unit_mm, height_at(seen.place)},
            {ux / length, uy / length},
            seen.along_mm / unit_mm,
            seen.across_mm / unit_mm};
        double vanishing[2];
        if (!residual(lamp_of(i), shared.pin_shift, &shared.size, vanishing))
            return;
        pins.emplace_back(terms.add<2, 3, 3, 1>(residual, terms.cauchy(3), lamp_of(i), shared.pin_shift, &shared.size),
                          i);
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

    double log_power(int i, weft_vec3 lamp) const
    {
        const double squared = (double)weft_dot(lamp, lamp) / (unit_mm * unit_mm);
        return own[(size_t)i].level[1] + std::log(squared) - std::log(input->evidence[i].exposure);
    }

    /* One lamp has one power; it begins at the median. */
    void add_power(const weft_lamp_solution *guess)
    {
        std::vector<double> power;
        for (int i = 0; i < input->count; i++)
            if (input->evidence[i].exposure > 0)
                power.push_back(log_power(i, guess->place[i].position_mm));
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
        terms.add<3 * WEFT_TONE_TERMS, WEFT_TONE_TERMS>(smooth_residual{}, nullptr, shared.tone);
        /* Natural vignetting is cos^4 = 1 - 2 r^2 + ...; the rims of a lens take more, its design less. */
        shared.vignetting[0] = -2 * input->corner_radius_squared;
        terms.prior<2>(shared.vignetting, {vignetting_deviation, vignetting_deviation});
        terms.prior<3>(shared.ink, {ink_prior_deviation, shine_deviation, shine_width_deviation});
        for (auto &shift : shared.shift)
            terms.prior<2>(shift, {shift_deviation_mm / unit_mm, shift_deviation_mm / unit_mm});
        const double pin = pin_deviation_mm / unit_mm, flash = flash_deviation_mm / unit_mm;
        terms.prior<3>(shared.pin_shift, {pin, pin, pin});
        if (terms.problem.HasParameterBlock(&shared.size))
            terms.prior<1>(&shared.size, {size_deviation});
        hold(&shared.size);
        if (input->flash) {
            terms.prior(shared.beam, beam_deviation);
            terms.prior<3>(shared.flash, {flash, flash, flash});
        } else {
            terms.prior<WEFT_BEAM_TERMS>(shared.beam, {beam_power_deviation, 1, 1, 1, 1});
        }
        for (int i = 0; i < input->count; i++) {
            if (input->flash) {
                hold(own[(size_t)i].aim);
                continue;
            }
            terms.add<1, 3>(distance_residual{}, nullptr, lamp_of(i));
            terms.prior<2>(own[(size_t)i].aim, {aim_deviation_mm / unit_mm, aim_deviation_mm / unit_mm});
        }
        if (!input->tone_unknown)
            hold(shared.tone);
    }
};

} // namespace lamps

#endif
