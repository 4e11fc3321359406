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
constexpr double paper_deviation = 0.01, ink_deviation = 0.03;
constexpr double independent_samples = 30, independent_pair_samples = 200;

/* A sheet is flat within a millimetre over its half: what its slope adds to the error of a lamp's direction. */
constexpr double sheet_slope = 0.01;

/* What is known beforehand: lamps stand at some 700 mm, within a factor of e; a ball stands within a millimetre of its
 * place, the head of the pin within half of one; ink within a fifth. */
constexpr double typical_mm = 700, distance_deviation = 1, shift_deviation_mm = 1, pin_deviation_mm = 0.5;
constexpr double size_deviation = 0.1, power_deviation = 0.1, ink_prior_deviation = 0.2, vignetting_deviation = 0.2,
                 flash_deviation_mm = 60;

/* Ink shines: where it mirrors the lamp it reflects 1 + shine of what it does elsewhere; tangent of the angle from
 * there at which the shine has fallen to 1 / e. A lamp in the hand has a beam, cos^power about the place that it is
 * held towards. */
constexpr double shine_mean = 0.3, shine_deviation = 0.5, shine_width = 0.3, shine_width_deviation = 0.3;
constexpr double beam_power_mean = 1, beam_power_deviation = 1, aim_deviation_mm = 50;

/* Beams of flashes lie between that of a bare tube, cos^0, and one that leaves a stop less in the corners of a wide
 * lens, cos^4; a beam of cos^2 may be turned aside by six degrees. */
constexpr double beam_mean[WEFT_BEAM_TERMS] = {0, 0, -1, 0, -1}, beam_deviation[WEFT_BEAM_TERMS] = {0.2, 0.2, 1, 1, 1};

/* Light from elsewhere, a hundredth of the lamp's, makes ink a fifth brighter. */
constexpr double stray_share = 0.01;

/* Tone curves are smooth: of the coefficients, from one to the next, and of that from one to the next. */
constexpr double tone_deviation = 1, tone_slope_deviation = 0.3, tone_bend_deviation = 0.07;

/* A curve that rises less than this share of what sRGB does is none. */
constexpr double least_rise = 0.05;

/* Of two exposures: shutters err, and not all cameras round as others do. Of the light of a place in both:
 * what a hand that is not still changes, and what the mean over a square leaves of the rounding to 8 bits. */
constexpr double ratio_deviation = 0.02, pair_deviation = 0.01, rounding_deviation = 0.1 / 255;

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

/* An encoded value under the tone curve: the logarithm of its light, and how fast that rises, over what sRGB does. */
struct toned_value {
    double log_light, basis[WEFT_TONE_TERMS], rise_basis[WEFT_TONE_TERMS];

    template <typename T> T log_of(const T *tone) const
    {
        T value = T(log_light);
        for (int k = 0; k < WEFT_TONE_TERMS; k++)
            value += tone[k] * basis[k];
        return value;
    }

    template <typename T> T rise_of(const T *tone) const
    {
        T rise = T(1);
        for (int k = 0; k < WEFT_TONE_TERMS; k++)
            rise += tone[k] * rise_basis[k];
        return rise;
    }
};

/* The error of the model is divided by the rise of the curve: so it is that of the value in the file. An error of light
 * would vanish under a curve that is flat. */
struct paper_residual {
    mounting mount;
    double x, y, z, normal[2], radius_squared, weight; /* the normal is (normal[0], normal[1], 1) */
    toned_value value[3];
    const double *usual_tone; /* whose rise makes errors of values those of light */
    vec3 eye;
    bool is_ink;

    template <typename T>
    bool operator()(const T *unknown, const T *level, const T *tone, const T *vignetting, const T *ink, const T *beam,
                    const T *aim, T *residual) const
    {
        T lamp[3];
        mount.place(unknown, lamp);
        if (lamp[2] <= T(0.01))
            return false;
        const T dx = lamp[0] - x, dy = lamp[1] - y;
        const T dz = lamp[2] - z, facing = dx * normal[0] + dy * normal[1] + dz;
        if (facing <= T(0.01))
            return false;
        const T near_squared = dx * dx + dy * dy + dz * dz;
        const T far_squared = lamp[0] * lamp[0] + lamp[1] * lamp[1] + lamp[2] * lamp[2];
        const T fall = 1.0 + radius_squared * (vignetting[0] + radius_squared * vignetting[1]);
        if (fall <= T(0.05))
            return false;
        T common = log(facing) + log(far_squared) - 1.5 * log(near_squared) + log(fall);
        if (is_ink) {
            const T shine = 1.0 + ink[1] * lobe(lamp, dx, dy, sqrt(near_squared), exp(ink[2]));
            if (shine <= T(0.1))
                return false;
            common += ink[0] + log(shine);
        }
        if (mount.is_flash) {
            common += mount.log_beam(unknown, beam, x, y);
        } else {
            const T ax = lamp[0] - aim[0], ay = lamp[1] - aim[1], az = lamp[2] * lamp[2];
            const T along = ax * dx + ay * dy + az;
            if (along <= T(0))
                return false;
            common += beam[0] * (log(along) - 0.5 * log((ax * ax + ay * ay + az) * near_squared));
        }
        for (int c = 0; c < 3; c++) {
            const T rise = value[c].rise_of(tone);
            if (rise <= T(least_rise))
                return false;
            residual[c] = weight * value[c].rise_of(usual_tone) * (value[c].log_of(tone) - level[c] - common) / rise;
        }
        return true;
    }

    /* exp(-tan^2 / width^2) of the angle between the normal and the one that would mirror the lamp. */
    template <typename T> T lobe(const T *lamp, const T &dx, const T &dy, const T &near, const T &width) const
    {
        const double ex = eye[0] - x, ey = eye[1] - y, away = std::sqrt(ex * ex + ey * ey + eye[2] * eye[2]);
        const T hx = dx / near + ex / away, hy = dy / near + ey / away, hz = lamp[2] / near + eye[2] / away;
        return exp(-(hx * hx + hy * hy) / (hz * hz * width * width));
    }
};

struct highlight_residual {
    mounting mount;
    vec3 eye, ray, touch; /* in units; `touch` is where the ball touches the sheet by the drawing */
    double radius, deviation_rad;

    /* `size`: logarithm of that of balls and pin over what is told. */
    template <typename T> bool operator()(const T *unknown, const T *shift, const T *size, T *residual) const
    {
        const T ball = radius * exp(size[0]);
        const T centre[3] = {touch[0] + shift[0], touch[1] + shift[1], touch[2] + ball};
        T offset[3], half = T(0), square = T(0);
        for (int i = 0; i < 3; i++) {
            offset[i] = eye[i] - centre[i];
            half += offset[i] * ray[i];
            square += offset[i] * offset[i];
        }
        const T under = half * half - square + ball * ball;
        if (under <= T(1e-9)) /* the ray passes the ball */
            return false;
        const T along = -half - sqrt(under);
        T point[3], lamp[3], normal_part = T(0), normal[3], to[3], length = T(0);
        mount.place(unknown, lamp);
        for (int i = 0; i < 3; i++) {
            point[i] = eye[i] + ray[i] * along;
            normal[i] = (point[i] - centre[i]) / ball;
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
    vec3 head; /* by the drawing, and its height over the ground */
    double ground;
    double shadow[3], along[2], along_deviation, across_deviation;

    template <typename T> bool operator()(const T *unknown, const T *shift, const T *size, T *residual) const
    {
        T lamp[3], off[2];
        mount.place(unknown, lamp);
        const T height = ground + head[2] * exp(size[0]) + shift[2], above = lamp[2] - height;
        if (above <= T(0.05))
            return false;
        for (int axis = 0; axis < 2; axis++) {
            const T at = head[(size_t)axis] + shift[axis];
            off[axis] = at + (at - lamp[axis]) * (height - shadow[2]) / above - shadow[axis];
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

/* A place in two photographs that differ in exposure alone: the logarithms of its light differ by that of the ratio. An
 * error of both values, as above. */
struct pair_residual {
    toned_value bright[3], dark[3];
    double weight[3];
    const double *usual_tone;

    template <typename T> bool operator()(const T *tone, const T *ratio, T *residual) const
    {
        for (int c = 0; c < 3; c++) {
            const T rises[2] = {bright[c].rise_of(tone), dark[c].rise_of(tone)};
            const double usual[2] = {bright[c].rise_of(usual_tone), dark[c].rise_of(usual_tone)};
            if (rises[0] <= T(least_rise) || rises[1] <= T(least_rise))
                return false;
            const T rise =
                sqrt((rises[0] * rises[0] + rises[1] * rises[1]) / (usual[0] * usual[0] + usual[1] * usual[1]));
            residual[c] = weight[c] * (bright[c].log_of(tone) - dark[c].log_of(tone) - ratio[c]) / rise;
        }
        return true;
    }
};

/* The coefficients of the tone curve are near zero, change slowly, and bend little. */
struct smooth_residual {
    template <typename T> bool operator()(const T *tone, T *residual) const
    {
        for (int k = 0; k < WEFT_TONE_TERMS; k++) {
            residual[3 * k] = tone[k] / tone_deviation;
            residual[3 * k + 1] = k < 1 ? T(0) : (tone[k] - tone[k - 1]) / tone_slope_deviation;
            residual[3 * k + 2] = k < 2 ? T(0) : (tone[k] - 2.0 * tone[k - 1] + tone[k - 2]) / tone_bend_deviation;
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
