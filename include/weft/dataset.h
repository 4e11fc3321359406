/* The BTF dataset NAME.btf.h5: photographs of a material, registered texel by texel. `weft register` and `weft import`
 * write it; `weft compress` and the player read it. To evaluate one, see weft/evaluate.h.
 *
 * HDF5, readable with h5py (docs/reference/dataset-format.md). Samples are half floats, texel-major: all images of a
 * texel are contiguous and a chunk is a block of texels, so that a fit reads what it needs and no more. */
#ifndef WEFT_DATASET_H
#define WEFT_DATASET_H

#include "weft/status.h"
#include "weft/types.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a sample measures. */
typedef enum weft_values {
    WEFT_REFLECTANCE_COSINE, /* BRDF x pi x cos(theta_light): 1 for a perfect white diffuser lit along its normal */
    WEFT_REFLECTANCE         /* BRDF x pi, without the cosine */
} weft_values;

/* Whether lights and views are directions or places. */
typedef enum weft_distance {
    WEFT_FAR, /* unit directions, the same for all texels */
    WEFT_NEAR /* positions in mm, origin at the centre of the material, frame as in weft/types.h */
} weft_distance;

/* Why a sample cannot be used (bits); 0 is a valid sample. One with another bit, which only others write, is not. */
enum {
    WEFT_MASK_MISSING = 1, /* no photograph, or its view could not be registered */
    WEFT_MASK_SATURATED =
        2,             /* the sensor clipped: a sample with this bit alone is a lower bound, 0 where none is known */
    WEFT_MASK_DARK = 8 /* too dark to be read: noise, or a few steps of the file, as large as its value */
};

/* Numbers that may be known about every image. */
typedef enum weft_image_figure {
    WEFT_IMAGE_WEIGHT,      /* what its samples count for in a fit; only ratios matter */
    WEFT_IMAGE_VIEW_ERROR,  /* standard error of the direction of its view, degrees */
    WEFT_IMAGE_LIGHT_ERROR, /* standard error of the direction of its light, degrees */
    WEFT_IMAGE_VALUE_ERROR, /* relative standard error of its samples, as far as they share it */
    WEFT_IMAGE_FIGURES
} weft_image_figure;

/* Everything but the samples. */
typedef struct weft_dataset_layout {
    int width, height; /* texels; row 0 is the top row (v near 1) */
    int image_count;   /* photographs, in any order */
    int view_count;    /* distinct views among them */
    weft_values values;
    weft_distance distance;
    double texel_pitch_mm;              /* the root of the area of a texel */
    double texel_aspect;                /* width over height of a texel; 0: not known, taken for square */
    double plane_mm;                    /* of the plane that the cloth is taken for, above that of the texels */
    weft_vec3 *light;                   /* [image_count] direction or position */
    weft_vec3 *view;                    /* [view_count] direction or position */
    int32_t *view_of_image;             /* [image_count] index into view */
    double *figure[WEFT_IMAGE_FIGURES]; /* [image_count] each, finite and >= 0; NULL: not known */
    char *provenance; /* JSON text: where the samples come from and what was done to them; never NULL once read */
} weft_dataset_layout;

/* Allocates the arrays of a layout whose counts are set (provenance becomes "{}", no figure is known); the caller frees
 * them with weft_dataset_layout_free. Errors: WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_layout_allocate(weft_dataset_layout *layout, weft_error *error);
WEFT_API void weft_dataset_layout_free(weft_dataset_layout *layout);

/* Width and height of the material, mm. Pure. */
WEFT_API void weft_dataset_size_mm(const weft_dataset_layout *layout, double size_mm[2]);

/* Unit direction from the centre of texel (x, y) to the light of an image, or to the camera of a view.
 * Far datasets give the stored direction. Pure. */
WEFT_API weft_vec3 weft_dataset_light_direction(const weft_dataset_layout *layout, int image, int x, int y);
WEFT_API weft_vec3 weft_dataset_view_direction(const weft_dataset_layout *layout, int view, int x, int y);

/* ---- Reading ---- */

typedef struct weft_dataset weft_dataset;

/* Opens a dataset and checks every shape, index and direction in it. The caller closes it with weft_dataset_close.
 * HDF5 is not thread-safe: while one thread opens, reads, writes or closes a dataset, no other thread may do so with
 * any dataset. Errors: WEFT_MISSING; WEFT_DAMAGED where HDF5 cannot read the file; WEFT_NOT_SUPPORTED for another
 * version; WEFT_BAD_INPUT naming what is wrong in it; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_open(const char *path, weft_dataset **result, weft_error *error);

/* NULL is fine. */
WEFT_API void weft_dataset_close(weft_dataset *dataset);

/* What it holds, and the path it was opened with. Owned by the dataset. Pure. */
WEFT_API const weft_dataset_layout *weft_dataset_get_layout(const weft_dataset *dataset);
WEFT_API const char *weft_dataset_path(const weft_dataset *dataset);

/* Reads the block of texels [x, x + width) x [y, y + height): samples [height][width][image_count][3], mask
 * [height][width][image_count]; either may be NULL. Masked samples that are not finite are given as 0. Not thread-safe.
 * Errors: WEFT_DAMAGED for a truncated file; WEFT_BAD_INPUT where a sample that the mask calls valid is NaN or
 * infinite; WEFT_BAD_USAGE for a block outside the material; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_read_block(weft_dataset *dataset, int x, int y, int width, int height,
                                           weft_half *samples, uint8_t *mask, weft_error *error);

/* Opacity of the rows [y, y + height): [height][layout width][view_count], 0 (hole) .. 1, in `opacity`. All 1 where the
 * dataset holds none. Not thread-safe. Errors: WEFT_DAMAGED for a truncated file; WEFT_BAD_INPUT for an opacity that is
 * none; WEFT_BAD_USAGE for rows outside the material. */
WEFT_API weft_code weft_dataset_read_opacity(weft_dataset *dataset, int y, int height, float *opacity,
                                             weft_error *error);

/* Whether the dataset holds opacity; it may still be 1 everywhere. Pure. */
WEFT_API bool weft_dataset_has_opacity(const weft_dataset *dataset);

/* Whether the dataset knows the average frame of its texels. Pure. */
WEFT_API bool weft_dataset_has_frames(const weft_dataset *dataset);

/* Frames of the rows [y, y + height): [height][layout width][2][3], unit normal and unit tangent perpendicular
 * to it. z and x where the dataset holds none. Not thread-safe. Errors: WEFT_DAMAGED for a truncated file;
 * WEFT_BAD_INPUT for a frame that is none or lies below the horizon; WEFT_BAD_USAGE for rows outside the material. */
WEFT_API weft_code weft_dataset_read_frames(weft_dataset *dataset, int y, int height, float *frames, weft_error *error);

/* Heights of the surface (`weft relief`): two or so along each side of a texel, row 0 at the top. */
typedef struct weft_dataset_heights {
    int width, height; /* whole multiples of the texels, at most WEFT_MOST_HEIGHTS of them along a side */
    int level_count;   /* the finest mip levels on which they help, at least 1 */
    float *value;      /* [height][width] mm above the plane of the texels */
} weft_dataset_heights;

enum { WEFT_MOST_HEIGHTS = 8 };

/* Whether the dataset holds heights. Pure. */
WEFT_API bool weft_dataset_has_heights(const weft_dataset *dataset);

/* The heights of all texels; none (all zero) where the dataset holds none. Not thread-safe. Errors: WEFT_BAD_INPUT for
 * one that is not finite or lies further from the plane than twice the longer side; WEFT_DAMAGED; WEFT_OUT_OF_MEMORY.
 * The caller frees with weft_dataset_heights_free. */
WEFT_API weft_code weft_dataset_read_heights(weft_dataset *dataset, weft_dataset_heights *heights, weft_error *error);
WEFT_API void weft_dataset_heights_free(weft_dataset_heights *heights);

/* ---- Writing ---- */

/* Takes whole images in any order, spools them to a scratch file beside the target, and turns them
 * texel-major at the end; memory use does not grow with the number of images. Images never put are
 * masked WEFT_MASK_MISSING. */
typedef struct weft_dataset_writer weft_dataset_writer;

/* Copies `layout`; reserves the disk space. One of weft_dataset_writer_finish and weft_dataset_writer_abandon frees the
 * writer. Errors: WEFT_BAD_INPUT for an impossible layout, WEFT_SYSTEM. */
WEFT_API weft_code weft_dataset_writer_create(const char *path, const weft_dataset_layout *layout,
                                              weft_dataset_writer **result, weft_error *error);

/* samples [height][width][3], mask [height][width] (NULL: all valid); masked samples are stored as 0, but those that
 * are WEFT_MASK_SATURATED alone as they are, if they are finite and not negative. May be called from several threads
 * for distinct images. Errors: WEFT_BAD_INPUT for a valid sample that is not finite, WEFT_SYSTEM.
 */
WEFT_API weft_code weft_dataset_writer_put_image(weft_dataset_writer *writer, int image, const weft_half *samples,
                                                 const uint8_t *mask, weft_error *error);

/* Optional, once: opacity [height][width][view_count], copied. Errors: WEFT_BAD_INPUT for one that is not in 0..1,
 * WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_writer_put_opacity(weft_dataset_writer *writer, const float *opacity,
                                                   weft_error *error);

/* Optional, once: frames [height][width][2][3] as weft_dataset_read_frames gives them, copied. Errors: WEFT_BAD_INPUT
 * for one that is none, WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_writer_put_frames(weft_dataset_writer *writer, const float *frames, weft_error *error);

/* Optional, once: heights of the surface, copied. Errors: WEFT_BAD_INPUT for some that a reader would refuse,
 * WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_writer_put_heights(weft_dataset_writer *writer, const weft_dataset_heights *heights,
                                                   weft_error *error);

/* Optional: a figure of every image [image_count], copied; replaces that of the layout. Errors: WEFT_BAD_INPUT for one
 * that is not finite or negative, or weights that are all 0; WEFT_OUT_OF_MEMORY. */
WEFT_API weft_code weft_dataset_writer_put_figure(weft_dataset_writer *writer, weft_image_figure figure,
                                                  const double *value, weft_error *error);

/* Writes the file under its final name, atomically, and frees the writer, also on failure. `provenance` (JSON text, may
 * be NULL) replaces the one of the layout. Not thread-safe. Errors: WEFT_BAD_USAGE for provenance that is no JSON
 * object, WEFT_SYSTEM. */
WEFT_API weft_code weft_dataset_writer_finish(weft_dataset_writer *writer, const char *provenance, weft_error *error);

/* Frees the writer and removes what it wrote. NULL is fine. */
WEFT_API void weft_dataset_writer_abandon(weft_dataset_writer *writer);

#ifdef __cplusplus
}
#endif
#endif
