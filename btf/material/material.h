/* The material of weft/material.h in memory, laid out as it is uploaded to a GPU.
 *
 * Value of a texel (Daubert et al. 2001, eq. 1 and 2), as BRDF x pi, with a table of lights beside the one of views:
 *     f(l, v) = T(v) S(l) (rho + sum_i max(0, l' . diag(Cx, Cy, Cz)_i . v')^N_i)
 * l', v' in the frame of the texel. Where the largest channel of f is above the ceiling of the texel, f is scaled down
 * to it. Multiplied by l_z it is the dataset's reflectance times cosine. */
#ifndef WEFT_BTF_MATERIAL_MATERIAL_H
#define WEFT_BTF_MATERIAL_MATERIAL_H

#include "base/half.h"
#include "base/numeric/error_summary.h"
#include "base/status.h"
#include "btf/direction/frame.h"
#include "btf/material/components.h"
#include "btf/material/heights.h"
#include "btf/material/visibility.h"
#include "weft/material.h"

enum {
    WEFT_MATERIAL_MAX_LOBES = 3,
    WEFT_MATERIAL_MAX_LEVELS = 16,
    WEFT_MATERIAL_MAX_VIEWS = 4096,
    WEFT_MATERIAL_MAX_LIGHTS = 4096
};

/* One mip level, row 0 at the top. Every array is owned by the material; the first three are NULL without lobes. */
typedef struct weft_material_level {
    int width, height;
    int16_t *frame;     /* [height][width][3]: n_x, n_y (x 32767; n_z = sqrt(1 - n_x^2 - n_y^2)), azimuth of the tangent
                           about n, from x projected on the tangent plane, / pi (x 32767) */
    weft_half *diffuse; /* [height][width][4]: rho r, g, b; the ceiling of the texel, 0: none */
    weft_half *lobe;    /* [lobe_count][channel 3][height][width][4]: Cx, Cy, Cz, N; lies behind `diffuse` */
    uint8_t *table; /* [view_count][height][width][4]: r, g, b square-root coded, T = (code/255)^2; alpha = code/255.
                       NULL where the material has no views (T = 1, opaque) */
    uint8_t *light_table; /* [light_count][height][width][4]: r, g, b coded alike, S = (code/255)^2; 255 unused. Only
                             of a file of version 1; else NULL (S = 1) */
    weft_error_summary error; /* the decoded material against the valid samples (reflectance times cosine) that it was
                                 fitted to; its percentiles are accurate to 2 % of their value */
} weft_material_level;

/* Its reflectance by lobes, by components, or by both, of which components are nearer to the photographs. */
struct weft_material {
    bool has_lobes;        /* diffuse terms and frames, and lobe_count lobes */
    int lobe_count;        /* 0..WEFT_MATERIAL_MAX_LOBES */
    int level_count;       /* level k + 1 has ceil half the size of level k, down to 1 x 1 */
    int view_count;        /* directions of T and of the opacity; 0 without a table */
    int light_count;       /* directions of S, which only a file of version 1 has; it is not written */
    double texel_pitch_mm; /* of level 0 */
    weft_vec3 *view;       /* [view_count], unit, upper hemisphere */
    weft_vec3 *light;      /* [light_count], unit, upper hemisphere */
    weft_material_level level[WEFT_MATERIAL_MAX_LEVELS];
    weft_components *components;          /* NULL without */
    weft_material_heights *heights;       /* that its components are seen through; NULL without */
    weft_material_visibility *visibility; /* what the scene reaches that it was pruned for; NULL where it was not */
    char *metadata;                       /* JSON text: provenance, fit settings; never NULL once read */
};

/* Allocates all arrays of a material of lobes (zeroed) for a level 0 of width x height; full mip chain when
 * `with_levels`, else one level. metadata = "{}". Errors: WEFT_BAD_USAGE for counts out of range, WEFT_SYSTEM. */
weft_code weft_material_create(int width, int height, int lobe_count, int view_count, int light_count, int with_levels,
                               weft_material *material, weft_error *error);

/* The same without diffuse terms, frames and lobes, for components. A table of views holds the opacity alone. */
weft_code weft_material_create_without_lobes(int width, int height, int view_count, int with_levels,
                                             weft_material *material, weft_error *error);
void weft_material_free(weft_material *material);

/* Sets the ceiling of a texel: the least half float that is not below `value`; 0 or less: none. Thread-safe. */
void weft_material_set_ceiling(weft_material_level *level, size_t texel, float value);

/* Puts heights, which are taken, into the place of those that it has; NULL: none. */
void weft_material_take_heights(weft_material *material, weft_material_heights *heights);

/* The same of what a scene reaches of it. */
void weft_material_take_visibility(weft_material *material, weft_material_visibility *visibility);

/* Whether it has components and no lobes. The errors of level 0 are then those of
 * the components at the texels that they were learned from; other levels have none. Pure. */
bool weft_material_has_components_alone(const weft_material *material);

/* Whose errors its levels have, where that is not all of it: "components", "lobes beside the components" or "diffuse
 * term beside the components"; NULL without components. Pure. */
const char *weft_material_errors_of(const weft_material *material);

/* Whether it can be written: not where it has a light table, of a file of version 1. Errors: WEFT_BAD_USAGE. */
weft_code weft_material_check_writable(const weft_material *material, weft_error *error);

/* Bytes of the file that weft_material_write would write. Errors: as there. */
weft_code weft_material_size(const weft_material *material, uint64_t *size, weft_error *error);

/* The same in two parts: what grows with the number of texels, and what all of them share. Errors: as there. */
weft_code weft_material_weigh(const weft_material *material, uint64_t *by_texels, uint64_t *shared, weft_error *error);

/* weft_material_open into a struct of the caller, who frees with weft_material_free. */
weft_code weft_material_read(const char *path, weft_material *material, weft_error *error);

/* The metadata alone; the caller frees. Errors: as above, as far as the container and the metadata show them. */
weft_code weft_material_read_metadata(const char *path, char **metadata, weft_error *error);

#endif
