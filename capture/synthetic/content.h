/* What lies in the opening of the sheet: a weave, a stitch, or a checker of patches whose reflectance is a formula. */
#ifndef WEFT_CAPTURE_SYNTHETIC_CONTENT_H
#define WEFT_CAPTURE_SYNTHETIC_CONTENT_H

#include "capture/virtual/sample.h"

enum { WEFT_SYNTHETIC_CHECKS = 4, WEFT_SYNTHETIC_LIGHTS = 2 };

typedef struct weft_synthetic_content {
    double opening_mm;
    bool is_checker;
    weft_virtual_sample cloth; /* empty where it is a checker */
} weft_synthetic_content;

/* `name` is a file of a weave or a stitch, or "checker". The caller frees. Errors: those of weft_virtual_sample_read.
 */
weft_code weft_synthetic_content_read(const char *name, double opening_mm, uint64_t seed,
                                      weft_synthetic_content *content, char warning[WEFT_MESSAGE_SIZE],
                                      weft_error *error);
void weft_synthetic_content_free(weft_synthetic_content *content);

/* A point in the opening, mm, seen and lit from some sides: unit vectors. A stitch follows path `index` of `key`. */
typedef struct weft_synthetic_glance {
    double x_mm, y_mm;
    weft_vec3 toward_camera, toward_light[WEFT_SYNTHETIC_LIGHTS];
    int light_count;
    uint64_t key;
    uint32_t index;
} weft_synthetic_glance;

/* pi BRDF cosine(light) for each light. Pure. */
void weft_synthetic_content_shade(const weft_synthetic_content *content, const weft_synthetic_glance *glance,
                                  weft_rgb shade[WEFT_SYNTHETIC_LIGHTS]);

/* The checker: WEFT_SYNTHETIC_CHECKS squares along a side, counted from the lower left. Each is diffuse,
 *     red = 0.10 + 0.75 ((5 i + 3 j) mod 7) / 6, green, blue the same of (3 i + 5 j) and (2 i + 6 j),
 * but for (1, 2), which is diffuse of 0.2 and has a highlight of Blinn (1977) over it: pi BRDF = 0.2 +
 * 0.15 (n + 8) / 8 cos(half)^n, n = 40. Returns pi BRDF without the cosine. Pure. */
weft_rgb weft_synthetic_checker(double opening_mm, double x_mm, double y_mm, weft_vec3 light, weft_vec3 view);

/* pi BRDF cosine(light), averaged over texel (x, y) of size x size texels over the opening, row 0 at the top, for a
 * light and a camera at places, mm: what a sample of a dataset should be. Pure. */
weft_rgb weft_synthetic_content_truth(const weft_synthetic_content *content, int size, int x, int y, weft_vec3 light,
                                      weft_vec3 camera);

#endif
