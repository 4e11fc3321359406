/* What the reader and the writer of datasets share: names of docs/reference/dataset-format.md and small helpers over
 * the HDF5 library. Private to btf/. HDF5 is not thread-safe; neither is this. */
#ifndef WEFT_BTF_DATASET_HDF5_H
#define WEFT_BTF_DATASET_HDF5_H

#include "btf/dataset/dataset.h"

#include <hdf5.h>
#include <stdbool.h>

enum { WEFT_DATASET_VERSION = 1 };

#define WEFT_DATASET_FORMAT "weft btf"
#define WEFT_DATASET_COLOUR_SPACE "linear Rec. 709"
#define WEFT_DATASET_LOWER_BOUNDS "lower bounds"

extern const char *const weft_values_name[2];   /* by weft_values */
extern const char *const weft_distance_name[2]; /* by weft_distance */
extern const char *const weft_image_figure_name[WEFT_IMAGE_FIGURES];

/* An open dataset. */
struct weft_dataset {
    char *path;
    uint64_t file_size;
    weft_dataset_layout layout;
    hid_t file, half, samples, mask;
    hid_t transfer;                 /* of weft_hdf5_whole_transfer */
    hid_t opacity, frames, heights; /* invalid where the file has none */
    int heights_width, heights_height, heights_levels;
    bool has_bounds; /* what is only saturated is a lower bound; else it means nothing */
};

/* Keeps HDF5 from printing its error stack. */
void weft_hdf5_quiet(void);

/* The innermost message of HDF5's error stack, for our own one-line errors; "" where there is none. Valid until the
 * next call. */
const char *weft_hdf5_cause(void);

/* IEEE binary16, which HDF5 1.10 has no name for; h5py shows it as float16. The caller closes it. Negative on failure.
 */
hid_t weft_hdf5_half_type(void);

/* A property list for H5Dread that refuses a number which the whole numbers asked for cannot hold (a negative one, a
 * fraction), where HDF5 would take the nearest. The caller closes it. Negative on failure. */
hid_t weft_hdf5_whole_transfer(void);

/* Opens a dataset of the file so that its filtered chunks, once decoded, are kept for a while. Negative on failure. */
hid_t weft_hdf5_open_cached(hid_t file, const char *name);

/* Checks every count, index, direction, figure and the provenance of a layout. Errors: `code` with a message that
 * starts with `path`. */
weft_code weft_dataset_layout_check(const weft_dataset_layout *layout, const char *path, weft_code code,
                                    weft_error *error);

/* The counts of the layout alone, so that arrays can be allocated. Errors as above. */
weft_code weft_dataset_layout_check_counts(const weft_dataset_layout *layout, const char *path, weft_code code,
                                           weft_error *error);

/* That each of `count` frames [2][3] is a unit normal not below the horizon and a unit tangent perpendicular to it, to
 * 0.001; `row` is the first of them, `width` frames long. Errors as above. */
weft_code weft_dataset_frames_check(const float *frames, size_t count, int row, int width, const char *path,
                                    weft_code code, weft_error *error);

/* That heights are finite and not further from the plane than twice the longer side, and as many as can be. Errors as
 * above. */
weft_code weft_dataset_heights_check(const weft_dataset_layout *layout, const weft_dataset_heights *heights,
                                     const char *path, weft_code code, weft_error *error);

/* That a figure, where it is known, is finite and not negative for every image, and weights are not all 0. Errors as
 * above. */
weft_code weft_dataset_figure_check(const weft_dataset_layout *layout, weft_image_figure figure, const char *path,
                                    weft_code code, weft_error *error);

/* That `text` is a JSON object. Errors as above. */
weft_code weft_dataset_provenance_check(const char *text, const char *path, weft_code code, weft_error *error);

#endif
