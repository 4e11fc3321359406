/* What light obeys, and what is known of a lamp beforehand: the residuals of the search for lamps, in standard errors.
 * For the bridge alone. */
#ifndef WEFT_REGISTRATION_LAMP_LAMP_LAWS_H
#define WEFT_REGISTRATION_LAMP_LAMP_LAWS_H

#include "registration/lamp/lamp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lamps
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

/* Tone curves are smooth: the higher a power, the less of it. */
constexpr double tone_deviation[WEFT_TONE_TERMS] = {0.5, 0.5, 0.25, 0.25, 0.125};

/* Of two exposures: shutters err, and not all cameras round as others do. Of the light of a place in both:
 * what a hand that is not still changes, and what the mean over a square leaves of the rounding to 8 bits. */
constexpr double ratio_deviation = 0.02, pair_deviation = 0.02, rounding_deviation = 0.1 / 255;

using vec3 = std::array<double, 3>;

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

/* A place in two photographs that differ in exposure alone: the logarithms of its light differ by that of the ratio. */
struct pair_residual {
    double difference[3], power[3][WEFT_TONE_TERMS], weight[3];

    template <typename T> bool operator()(const T *tone, const T *ratio, T *residual) const
    {
        for (int c = 0; c < 3; c++) {
            T value = difference[c] - ratio[c];
            for (int k = 0; k < WEFT_TONE_TERMS; k++)
                value += tone[k] * power[c][k];
            residual[c] = weight[c] * value;
        }
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

} // namespace lamps

#endif
