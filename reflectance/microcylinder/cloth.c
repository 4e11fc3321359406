/* Cloth of two microcylinder threads: its tangents and their weighted sum. */
#include "reflectance/microcylinder/microcylinder.h"

#define MIN_LIGHT_COSINE 1e-6

/* Room for the rounding of two shares that sum to 1. */
#define MAX_AREA (1 + 1e-6)

static weft_real thread_length(const weft_cloth_thread *thread)
{
    weft_real length = 0;
    for (int i = 0; i + 1 < thread->point_count; i++)
        length += thread->piece_length[i];
    return length;
}

static bool thread_admissible(const weft_cloth_thread *thread)
{
    bool counts = thread->point_count >= 2 && thread->point_count <= WEFT_THREAD_MAX_POINTS &&
                  thread->sample_count >= 1 && thread->sample_count <= WEFT_THREAD_MAX_SAMPLES;
    if (!counts || !weft_thread_optics_admissible(&thread->optics))
        return false;
    for (int i = 0; i < thread->point_count; i++) {
        if (!(fabs(thread->tilt_rad[i]) <= (weft_real)(WEFT_PI / 2)))
            return false;
        if (i + 1 < thread->point_count && !(thread->piece_length[i] >= 0))
            return false;
    }
    weft_real length = thread_length(thread);
    return length > 0 && length <= (weft_real)WEFT_THREAD_MAX_PARAMETER && thread->area_share >= 0;
}

bool weft_microcylinder_admissible(const weft_microcylinder_cloth *cloth)
{
    return cloth->sigma >= (weft_real)WEFT_THREAD_MIN_WIDTH && cloth->sigma <= (weft_real)WEFT_THREAD_MAX_PARAMETER &&
           thread_admissible(&cloth->thread[0]) && thread_admissible(&cloth->thread[1]) &&
           cloth->thread[0].area_share + cloth->thread[1].area_share <= (weft_real)MAX_AREA;
}

/* Tilt at a distance along the thread. */
static weft_real tilt_at(const weft_cloth_thread *thread, weft_real distance)
{
    int piece = 0;
    while (piece + 2 < thread->point_count && distance > thread->piece_length[piece])
        distance -= thread->piece_length[piece++];
    weft_real length = thread->piece_length[piece];
    weft_real part = length > 0 ? weft_clamp(distance / length, 0, 1) : 0;
    return thread->tilt_rad[piece] + (thread->tilt_rad[piece + 1] - thread->tilt_rad[piece]) * part;
}

static void sample_tangents(const weft_cloth_thread *thread, weft_thread_tangent *tangent)
{
    weft_real length = thread_length(thread);
    for (int i = 0; i < thread->sample_count; i++) {
        weft_real distance = ((weft_real)i + (weft_real)0.5) / (weft_real)thread->sample_count * length;
        tangent[i] = weft_thread_tangent_of(thread->axis, tilt_at(thread, distance));
    }
}

weft_prepared_cloth weft_microcylinder_prepare(const weft_microcylinder_cloth *cloth)
{
    weft_prepared_cloth prepared = {.cloth = *cloth, .admissible = weft_microcylinder_admissible(cloth)};
    for (int j = 0; prepared.admissible && j < WEFT_CLOTH_THREADS; j++)
        sample_tangents(&cloth->thread[j], prepared.tangent[j]);
    return prepared;
}

static void add_scaled(weft_rgb *sum, weft_real weight, weft_rgb value)
{
    sum->r += weight * value.r;
    sum->g += weight * value.g;
    sum->b += weight * value.b;
}

/* Sum over the tangents of one thread of f_s M cos(theta_light). */
static weft_rgb thread_sum(const weft_prepared_cloth *prepared, int j, weft_vec3 light, weft_vec3 view)
{
    const weft_cloth_thread *thread = &prepared->cloth.thread[j];
    weft_rgb sum = {0};
    for (int i = 0; i < thread->sample_count; i++) {
        weft_thread_angles angles = weft_thread_angles_of(&prepared->tangent[j][i], light, view);
        weft_real shadowing = weft_thread_shadowing(&angles, prepared->cloth.sigma);
        if (shadowing > 0)
            add_scaled(&sum, shadowing * angles.cos_theta_light, weft_thread_scattering(&thread->optics, &angles));
    }
    return sum;
}

static weft_real uncovered_share(const weft_prepared_cloth *prepared)
{
    return fmax(1 - prepared->cloth.thread[0].area_share - prepared->cloth.thread[1].area_share, 0);
}

weft_rgb weft_microcylinder_scattering(const weft_prepared_cloth *prepared, weft_cloth_weighting weighting,
                                       weft_vec3 light, weft_vec3 view)
{
    weft_rgb k = {0};
    if (!prepared->admissible || !(light.z > 0 && view.z > 0))
        return k;
    const weft_cloth_thread *thread = prepared->cloth.thread;
    weft_real met = weighting == WEFT_CLOTH_BY_AREA ? uncovered_share(prepared) * view.z : 0;
    for (int j = 0; j < WEFT_CLOTH_THREADS; j++) {
        weft_real projection = weft_thread_projection(thread[j].axis, prepared->cloth.sigma, light, view);
        weft_real samples = (weft_real)thread[j].sample_count;
        bool by_area = weighting == WEFT_CLOTH_BY_AREA;
        met += projection * (by_area ? thread[j].area_share : samples);
        add_scaled(&k, projection * thread[j].area_share / (by_area ? samples : 1),
                   thread_sum(prepared, j, light, view));
    }
    return met > 0 ? (weft_rgb){k.r / met, k.g / met, k.b / met} : (weft_rgb){0};
}

weft_rgb weft_microcylinder_brdf(const weft_prepared_cloth *prepared, weft_cloth_weighting weighting, weft_vec3 light,
                                 weft_vec3 view)
{
    weft_rgb k = weft_microcylinder_scattering(prepared, weighting, light, view);
    weft_real cosine = fmax(light.z, (weft_real)MIN_LIGHT_COSINE);
    return (weft_rgb){k.r / cosine, k.g / cosine, k.b / cosine};
}

static void set_texel(float texel[4], weft_real r, weft_real g, weft_real b, weft_real a)
{
    texel[0] = (float)r;
    texel[1] = (float)g;
    texel[2] = (float)b;
    texel[3] = (float)a;
}

void weft_microcylinder_table(const weft_prepared_cloth *prepared, float (*rgba)[4])
{
    set_texel(*rgba++, prepared->admissible, prepared->cloth.sigma, uncovered_share(prepared), 0);
    for (int j = 0; j < WEFT_CLOTH_THREADS; j++) {
        const weft_cloth_thread *thread = &prepared->cloth.thread[j];
        const weft_thread_optics *optics = &thread->optics;
        set_texel(*rgba++, thread->axis == WEFT_AXIS_X ? 0 : 1, (weft_real)thread->sample_count, thread->area_share, 0);
        set_texel(*rgba++, optics->eta, optics->gamma_s, optics->gamma_v, optics->kd);
        set_texel(*rgba++, optics->albedo.r, optics->albedo.g, optics->albedo.b, 0);
        for (int i = 0; i < WEFT_THREAD_MAX_SAMPLES; i++)
            set_texel(*rgba++, prepared->tangent[j][i].cos_tilt, prepared->tangent[j][i].sin_tilt, 0, 0);
    }
}
