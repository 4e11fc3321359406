/* Of datasets (weft/dataset.h) what only the library needs. */
#ifndef WEFT_BTF_DATASET_DATASET_H
#define WEFT_BTF_DATASET_DATASET_H

#include "base/half.h"
#include "base/status.h"
#include "base/vector.h"
#include "weft/dataset.h"

/* Zeros for one figure of every image, in layout->figure. Errors: WEFT_SYSTEM. */
weft_code weft_dataset_layout_allocate_figure(weft_dataset_layout *layout, weft_image_figure figure, weft_error *error);

/* Width over height of a texel. Pure. */
double weft_dataset_texel_aspect(const weft_dataset_layout *layout);

/* Keeps fewer decoded chunks, for a reader of square blocks that reads each once. *bytes receives what the HDF5 library
 * may take from now on for chunks. Errors: WEFT_BAD_INPUT. */
weft_code weft_dataset_limit_cache(weft_dataset *dataset, uint64_t *bytes, weft_error *error);

/* The surface that the photographs are to be seen through: the heights, or the plane as one height (1 x 1) that helps
 * on the levels whose texels are no more than twice as large as it is far from them; none where the dataset has
 * neither, or near lights and views. Errors and ownership as above. */
weft_code weft_dataset_read_surface(weft_dataset *dataset, weft_dataset_heights *surface, weft_error *error);

/* Whether weft_dataset_read_surface finds one. */
bool weft_dataset_has_surface(const weft_dataset *dataset);

/* Gives the closed dataset `path` a plane and heights (NULL: none), in the place of those that it has, and the JSON
 * object `made` in its provenance under "relief". The file is written anew and then takes the name `output`, which may
 * be `path`. Errors: WEFT_BAD_INPUT for heights that a reader would refuse; those of reading and writing; WEFT_SYSTEM.
 */
weft_code weft_dataset_put_relief(const char *path, const char *output, double plane_mm,
                                  const weft_dataset_heights *heights, const char *made, weft_error *error);

/* As many rows as hold about 64 MiB of samples: chunks span several rows, and each should be read once. At least 1.
 * Pure. */
int weft_dataset_rows_at_once(const weft_dataset_layout *layout);

#endif
