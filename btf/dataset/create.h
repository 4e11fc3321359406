/* The HDF5 side of writing a dataset: an empty file of its final size, then blocks of texels. Private to btf/. */
#ifndef WEFT_BTF_DATASET_CREATE_H
#define WEFT_BTF_DATASET_CREATE_H

#include "btf/dataset/hdf5.h"

/* A file being written. Identifiers are H5I_INVALID_HID where not open. */
typedef struct weft_dataset_file {
    const char *path; /* final path, for messages; not owned */
    hid_t file, half, samples, mask;
} weft_dataset_file;

/* Width and height of a chunk, texels (docs/reference/dataset-format.md, Storage). Pure. */
void weft_dataset_chunk(const weft_dataset_layout *layout, int *width, int *height);

/* Creates `temporary_path` with everything but samples, masks, figures, provenance, opacity and frames, and reserves
 * the disk space of the samples. Errors: WEFT_SYSTEM, with messages that name `path`. */
weft_code weft_dataset_create(const char *temporary_path, const char *path, const weft_dataset_layout *layout,
                              weft_error *error);

/* Opens what weft_dataset_create made. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_open(const char *temporary_path, const char *path, weft_dataset_file *file,
                                 weft_error *error);

/* Writes texels [x, x + width) x [y, y + height): samples [height][width][image_count][3] and mask
 * [height][width][image_count]. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_write(const weft_dataset_file *file, const weft_dataset_layout *layout, int x, int y,
                                  int width, int height, const weft_half *samples, const uint8_t *mask,
                                  weft_error *error);

/* opacity [height][width][view_count]. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_write_opacity(const weft_dataset_file *file, const weft_dataset_layout *layout,
                                          const float *opacity, weft_error *error);

/* frames [height][width][2][3]. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_write_frames(const weft_dataset_file *file, const weft_dataset_layout *layout,
                                         const float *frames, weft_error *error);

/* The figures of the layout that are known. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_write_figures(const weft_dataset_file *file, const weft_dataset_layout *layout,
                                          weft_error *error);

/* Writes the provenance, in the place of one that the file has. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_write_provenance(const weft_dataset_file *file, const char *text, weft_error *error);

/* A plane and heights (NULL: none) in the place of those that the file has. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_file_write_relief(const weft_dataset_file *file, double plane_mm,
                                         const weft_dataset_heights *heights, weft_error *error);

/* Closes everything. Errors: WEFT_SYSTEM where what HDF5 still held cannot be written. */
weft_code weft_dataset_file_close(weft_dataset_file *file, weft_error *error);

#endif
