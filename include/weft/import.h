/* Import: collections of photographs that others made become a dataset (docs/reference/import-layouts.md).
 *
 *   - a folder with positions: NN.png, camera_pos.txt, light_pos.txt, image_size.txt, light_power.txt
 *     (a near light and a near camera);
 *   - a folder of photographs named by their angles, in the layouts of UTIA (tv045_pv090/tl030_pl120_tv045_pv090.png)
 * and UBO2003 ("00008 tl000 pl000 tv030 pv030.jpg"), or listed in a directions.csv (far light and camera);
 *   - a folder with an .lp file: one view, many lamps (far light and camera);
 *   - a binary BTF file of the University of Bonn (UBO2014): all images as products of matrices (far light and camera).
 */
#ifndef WEFT_IMPORT_H
#define WEFT_IMPORT_H

#include "weft/dataset.h"
#include "weft/progress.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_VALUES_OF_SOURCE = 2 };

/* What the numbers in photographs mean. */
typedef enum weft_import_colours {
    WEFT_IMPORT_AS_SAID, /* by each file itself, else sRGB */
    WEFT_IMPORT_SRGB,
    WEFT_IMPORT_GAMMA_22,
    WEFT_IMPORT_ADOBE_RGB,
    WEFT_IMPORT_DISPLAY_P3,
    WEFT_IMPORT_XYZ
} weft_import_colours;

typedef struct weft_import_options {
    int width;             /* of the dataset, texels; 0 = as photographed */
    double texel_pitch_mm; /* of the dataset; 0 = what the collection says, else 1 mm */
    /* Encoded value in 0..1 from which a sample of an integer image counts as clipped; > 1 = never. */
    double saturated_at;
    /* What photographs of a far light hold, a weft_values, or what the source says, else reflectance times cosine;
     * those of a near light always give reflectance times cosine. */
    int values;
    weft_import_colours colours;
    double white;       /* linear value of a perfect white diffuser in the photographs */
    bool linear;        /* integer images hold linear values, whatever their colours */
    const char *lights; /* an .lp file for photographs of one view; NULL: as the folder says */
    /* Mask photographs that cannot be used, and leave out duplicates, instead of failing. */
    bool skip_bad;
} weft_import_options;

/* What came of it; freed with weft_import_report_free. */
typedef struct weft_import_report {
    const char *kind; /* of collection, in words */
    int width, height, image_count, view_count;
    int missing_count;         /* photographs that the collection should hold but does not */
    int skipped_count;         /* photographs that skip_bad masked */
    double saturated_fraction; /* of the samples of the photographs that were read */
    double mean;               /* of the same: over all channels */
    double outside_fraction;   /* of the same: colours outside sRGB, with a negative channel */
    weft_lines notes;          /* what the user should know, a line each */
} weft_import_report;

/* Size as photographed, saturated from 250/255, reflectance times cosine, white 1, no bad photograph skipped. Pure. */
WEFT_API weft_import_options weft_import_defaults(void);

/* Reads the collection in the folder or file `source` and writes the dataset `output` atomically. Photographs are
 * decoded in parallel (OpenMP); memory holds one photograph a thread. Of a file of Bonn it holds the matrices, and up
 * to 16 images a thread.
 *
 * Integer images are decoded by the curve of their colours unless they are linear, float images are linear. Colours
 * become linear sRGB; those outside of it keep a negative channel. A smaller width averages exact areas in linear
 * light; a texel with any clipped pixel under it is masked WEFT_MASK_SATURATED. A near light of radiant
 * intensity I at distance d gives reflectance times cosine = pi p d^2 / I for a linear pixel value p = BRDF cos(theta)
 * I / d^2.
 *
 * `progress` may be NULL. One thread at a time may read or write datasets. The caller frees `report`, which may not be
 * NULL, where all went well. Errors: WEFT_BAD_INPUT naming the photograph or the table that cannot be used,
 * WEFT_MISSING where there is none, WEFT_NOT_SUPPORTED for a BTF file of Bonn of another kind; WEFT_SYSTEM. */
WEFT_API weft_code weft_import(const char *source, const char *output, const weft_import_options *options,
                               const weft_progress *progress, weft_import_report *report, weft_error *error);
WEFT_API void weft_import_report_free(weft_import_report *report);

#ifdef __cplusplus
}
#endif
#endif
