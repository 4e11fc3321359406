#include "registration/resample/resample.h"

#include "btf/dataset/dataset.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* A texel, mm on the plate. */
typedef struct square {
    double left, top, width, height;
} square;

/* The pixels that a quadrangle may touch: first and last, both included. */
typedef struct box {
    int x0, y0, x1, y1;
} box;

/* A texel of which a view sees less than this share is not seen in it. Measured in docs/notes/registration.md. */
static const double least_share_seen = 0.25;

/* How far along x and y, mm, the plate is seen within `reach_px` of a pixel at the plate point (x, y). */
static weft_pixel reach_on_plate(const weft_plate_view *view, double x, double y, double reach_px)
{
    weft_pixel at = weft_plate_view_see(view, x, y);
    weft_pixel left = weft_plate_view_meet(view, at.x - 0.5, at.y);
    weft_pixel right = weft_plate_view_meet(view, at.x + 0.5, at.y);
    weft_pixel above = weft_plate_view_meet(view, at.x, at.y - 0.5);
    weft_pixel below = weft_plate_view_meet(view, at.x, at.y + 0.5);
    return (weft_pixel){reach_px * (fabs(right.x - left.x) + fabs(below.x - above.x)),
                        reach_px * (fabs(right.y - left.y) + fabs(below.y - above.y))};
}

/* The texel moved inward until it keeps `reach` from the frame, or to the middle where that cannot be. */
static square kept_from_frame(square s, double opening_mm, weft_pixel reach)
{
    double limit_x = fmax(opening_mm / 2 - reach.x, s.width / 2);
    double limit_y = fmax(opening_mm / 2 - reach.y, s.height / 2);
    s.left = fmin(fmax(s.left, -limit_x), limit_x - s.width);
    s.top = fmax(fmin(s.top, limit_y), s.height - limit_y);
    return s;
}

/* Whether a pixel sees nothing but the sample: its square, and the point spread around that, lie in the opening. */
static bool is_clear(const weft_resampling *r, const weft_plate_view *view, int x, int y)
{
    weft_pixel at = weft_camera_undistort(r->camera, (weft_pixel){x, y});
    double reach = 0.5 + r->point_spread_px, half = r->opening_mm / 2;
    for (int corner = 0; corner < 4; corner++) {
        double dx = corner % 2 ? reach : -reach, dy = corner / 2 ? reach : -reach;
        weft_pixel plate = weft_plate_view_meet(view, at.x + dx, at.y + dy);
        if (!(fabs(plate.x) <= half && fabs(plate.y) <= half))
            return false;
    }
    return true;
}

static void corners_in_photograph(const weft_resampling *r, const weft_plate_view *view, square s, weft_pixel corner[4])
{
    for (int i = 0; i < 4; i++) {
        double x = s.left + (i == 1 || i == 2 ? s.width : 0), y = s.top - (i >= 2 ? s.height : 0);
        corner[i] = weft_camera_distort(r->camera, weft_plate_view_see(view, x, y));
    }
}

/* False where the quadrangle leaves the photograph. */
static bool box_of(const weft_camera *camera, const weft_pixel corner[4], box *b)
{
    double x0 = corner[0].x, x1 = x0, y0 = corner[0].y, y1 = y0;
    for (int i = 1; i < 4; i++) {
        x0 = fmin(x0, corner[i].x), x1 = fmax(x1, corner[i].x);
        y0 = fmin(y0, corner[i].y), y1 = fmax(y1, corner[i].y);
    }
    if (!(x0 >= -0.5 && y0 >= -0.5 && x1 <= camera->width - 0.5 && y1 <= camera->height - 0.5))
        return false;
    *b = (box){(int)(x0 + 0.5), (int)(y0 + 0.5), (int)(x1 + 0.5), (int)(y1 + 0.5)};
    b->x1 = b->x1 < camera->width ? b->x1 : camera->width - 1;
    b->y1 = b->y1 < camera->height ? b->y1 : camera->height - 1;
    return true;
}

/* How many taps there are, and room for how many. */
typedef struct taps {
    long used, capacity;
} taps;

static weft_code reserve_taps(weft_resampler *resampler, taps *t, long count, weft_error *error)
{
    if (t->used + count <= t->capacity)
        return WEFT_OK;
    long wanted = (t->used + count) * 2;
    int32_t *pixel = realloc(resampler->pixel, (size_t)wanted * sizeof *pixel);
    if (pixel)
        resampler->pixel = pixel;
    float *weight = realloc(resampler->weight, (size_t)wanted * sizeof *weight);
    if (weight)
        resampler->weight = weight;
    if (!pixel || !weight)
        return weft_fail_memory(error, "resampling weights", (size_t)wanted * 8);
    t->capacity = wanted;
    return WEFT_OK;
}

static bool is_blind(const weft_resampling *r, int x, int y)
{
    return r->inverse_vignetting && r->inverse_vignetting[(size_t)y * (size_t)r->camera->width + (size_t)x] == 0;
}

/* Appends the clear pixels of a quadrangle behind `first`, weighted by area; returns the end of its taps. `view` is
 * NULL where all are clear. *share receives how much of the quadrangle they cover. */
static long append_taps(const weft_resampling *r, const weft_plate_view *view, const weft_pixel corner[4], box b,
                        long first, weft_resampler *resampler, double *share)
{
    double whole = 0, clear = 0;
    long end = first;
    for (int y = b.y0; y <= b.y1; y++) {
        for (int x = b.x0; x <= b.x1; x++) {
            double area = weft_overlap_area(corner, x, y);
            if (area <= 0)
                continue;
            whole += area;
            if (is_blind(r, x, y) || (view && !is_clear(r, view, x, y)))
                continue;
            clear += area;
            resampler->pixel[end] = y * r->camera->width + x;
            resampler->weight[end++] = (float)area;
        }
    }
    *share = whole > 0 ? clear / whole : 0;
    return end;
}

/* Makes areas [first, end) weights, and returns their sum. */
static float finish_weights(const weft_resampling *r, long first, long end, weft_resampler *resampler)
{
    double area = 0, total = 0;
    for (long tap = first; tap < end; tap++)
        area += (double)resampler->weight[tap];
    for (long tap = first; tap < end; tap++) {
        double vignetting = r->inverse_vignetting ? (double)r->inverse_vignetting[resampler->pixel[tap]] : 1;
        resampler->weight[tap] = (float)((double)resampler->weight[tap] / area * vignetting);
        total += (double)resampler->weight[tap];
    }
    return (float)total;
}

/* Appends the taps of a square, of its clear pixels or of all. *used stays where it is not in the photograph, or less
 * of it seen than `least_share`. */
static weft_code append_square(const weft_resampling *r, const weft_plate_view *view, bool clear, square s,
                               double least_share, weft_resampler *resampler, taps *t, weft_error *error)
{
    weft_pixel corner[4];
    box b;
    double share;
    corners_in_photograph(r, view, s, corner);
    if (!box_of(r->camera, corner, &b))
        return WEFT_OK;
    WEFT_TRY(reserve_taps(resampler, t, (long)(b.x1 - b.x0 + 1) * (b.y1 - b.y0 + 1), error));
    long end = append_taps(r, clear ? view : NULL, corner, b, t->used, resampler, &share);
    if (share >= least_share)
        t->used = end;
    return WEFT_OK;
}

/* Appends the taps of a texel, none where it is not seen. */
static weft_code append_texel(const weft_resampling *r, const weft_plate_view *view, square s,
                              weft_resampler *resampler, taps *t, weft_error *error)
{
    long first = t->used;
    weft_pixel reach = reach_on_plate(view, s.left + s.width / 2, s.top - s.height / 2, 1 + r->point_spread_px);
    square inside = kept_from_frame(s, r->opening_mm, reach);
    bool is_inside = inside.left == s.left && inside.top == s.top;
    WEFT_TRY(append_square(r, view, !is_inside, s, least_share_seen, resampler, t, error));
    if (t->used == first && !is_inside && r->fill)
        WEFT_TRY(append_square(r, view, false, inside, 0, resampler, t, error));
    return WEFT_OK;
}

static weft_code fill(const weft_resampling *r, weft_resampler *resampler, weft_error *error)
{
    const weft_plate_view view = weft_plate_view_of(r->camera, &r->homography, &r->bend);
    double width = r->opening_mm / resampler->width, height = r->opening_mm / resampler->height;
    taps t = {0};
    long texel = 0;
    for (int y = 0; y < resampler->height; y++) {
        for (int x = 0; x < resampler->width; x++, texel++) {
            square s = {x * width - r->opening_mm / 2, r->opening_mm / 2 - y * height, width, height};
            resampler->first[texel] = t.used;
            WEFT_TRY(append_texel(r, &view, s, resampler, &t, error));
            resampler->sum[texel] = finish_weights(r, resampler->first[texel], t.used, resampler);
        }
    }
    resampler->first[texel] = t.used;
    return WEFT_OK;
}

weft_code weft_resampler_create(const weft_resampling *resampling, int width, int height, weft_resampler *resampler,
                                weft_error *error)
{
    *resampler = (weft_resampler){.width = width, .height = height};
    if (width < 1 || height < 1 || !(resampling->opening_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "an opening of %g mm cannot be resampled to %d x %d texels",
                         resampling->opening_mm, width, height);
    size_t texels = (size_t)width * (size_t)height;
    resampler->first = malloc((texels + 1) * sizeof *resampler->first);
    resampler->sum = calloc(texels, sizeof *resampler->sum);
    weft_code code = resampler->first && resampler->sum ? fill(resampling, resampler, error)
                                                        : weft_fail_memory(error, "a resampler", texels * 12);
    if (code != WEFT_OK)
        weft_resampler_free(resampler);
    return code;
}

void weft_resampler_free(weft_resampler *resampler)
{
    free(resampler->first);
    free(resampler->pixel);
    free(resampler->weight);
    free(resampler->sum);
    *resampler = (weft_resampler){0};
}

void weft_resampler_apply(const weft_resampler *resampler, const uint16_t *samples, int black_level, int full_scale,
                          float *texel, uint8_t *mask)
{
    long texels = (long)resampler->width * resampler->height;
    for (long i = 0; i < texels; i++) {
        double sum[3] = {0, 0, 0};
        int largest = 0;
        for (long tap = resampler->first[i]; tap < resampler->first[i + 1]; tap++) {
            const uint16_t *s = samples + 3 * (size_t)resampler->pixel[tap];
            for (int c = 0; c < 3; c++) {
                sum[c] += (double)resampler->weight[tap] * s[c];
                largest = s[c] > largest ? s[c] : largest;
            }
        }
        bool seen = resampler->first[i] < resampler->first[i + 1];
        mask[i] = !seen ? WEFT_MASK_MISSING : largest >= full_scale ? WEFT_MASK_SATURATED : 0;
        for (int c = 0; c < 3; c++)
            texel[3 * i + c] = (float)(sum[c] - (double)resampler->sum[i] * black_level);
    }
}

/* Sums over the taps of a texel; returns the variance of the mean over its channels. */
static double merged_texel(const weft_resampler *resampler, long i, const float *value, const float *variance,
                           float texel[3])
{
    double sum[3] = {0, 0, 0}, squares = 0;
    for (long tap = resampler->first[i]; tap < resampler->first[i + 1]; tap++) {
        size_t at = 3 * (size_t)resampler->pixel[tap];
        double weight = (double)resampler->weight[tap];
        for (int c = 0; c < 3; c++) {
            sum[c] += weight * (double)value[at + (size_t)c];
            squares += weight * weight * (double)variance[at + (size_t)c];
        }
    }
    for (int c = 0; c < 3; c++)
        texel[c] = (float)sum[c];
    return squares / 9;
}

void weft_resampler_apply_merged(const weft_resampler *resampler, const float *value, const float *variance,
                                 float *texel, uint8_t *mask)
{
    long texels = (long)resampler->width * resampler->height;
    for (long i = 0; i < texels; i++) {
        double squares = merged_texel(resampler, i, value, variance, texel + 3 * i);
        double mean = ((double)texel[3 * i] + (double)texel[3 * i + 1] + (double)texel[3 * i + 2]) / 3;
        bool seen = resampler->first[i] < resampler->first[i + 1];
        mask[i] = !seen                                 ? WEFT_MASK_MISSING
                  : !isfinite(mean)                     ? WEFT_MASK_SATURATED
                  : mean * mean <= squares || mean <= 0 ? WEFT_MASK_DARK
                                                        : 0;
    }
}

/* ---- How much of a quadrangle lies in a pixel ---- */

enum { corners_limit = 8 }; /* a quadrangle gains at most one corner at each of four cuts */

typedef struct polygon {
    int count;
    weft_pixel corner[corners_limit];
} polygon;

/* Keeps the part where sign * (coordinate - limit) >= 0; `vertical` chooses y. */
static polygon cut(const polygon *whole, int vertical, double limit, double sign)
{
    polygon part = {0};
    for (int i = 0; i < whole->count; i++) {
        weft_pixel a = whole->corner[i], b = whole->corner[(i + 1) % whole->count];
        double da = sign * ((vertical ? a.y : a.x) - limit), db = sign * ((vertical ? b.y : b.x) - limit);
        if (da >= 0)
            part.corner[part.count++] = a;
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            double t = da / (da - db);
            part.corner[part.count++] = (weft_pixel){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        }
    }
    return part;
}

/* Shoelace formula about the first corner. */
static double area_of(const polygon *p)
{
    double twice = 0;
    for (int i = 1; i + 1 < p->count; i++) {
        double ax = p->corner[i].x - p->corner[0].x, ay = p->corner[i].y - p->corner[0].y;
        double bx = p->corner[i + 1].x - p->corner[0].x, by = p->corner[i + 1].y - p->corner[0].y;
        twice += ax * by - ay * bx;
    }
    return 0.5 * fabs(twice);
}

double weft_overlap_area(const weft_pixel corner[4], int x, int y)
{
    polygon p = {4, {corner[0], corner[1], corner[2], corner[3]}};
    p = cut(&p, 0, x - 0.5, 1);
    p = cut(&p, 0, x + 0.5, -1);
    p = cut(&p, 1, y - 0.5, 1);
    p = cut(&p, 1, y + 0.5, -1);
    return area_of(&p);
}
