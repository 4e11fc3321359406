/* Heights as what other programs read. */
#ifndef WEFT_RELIEF_SURFACE_H
#define WEFT_RELIEF_SURFACE_H

#include "base/status.h"
#include "btf/dataset/dataset.h"

/* The surface as a Wavefront OBJ file with texture coordinates, written atomically: a vertex in the middle of every
 * place, in mm, the lower left corner of the material at the origin. Errors: WEFT_SYSTEM. */
weft_code weft_surface_write_obj(const char *path, const weft_dataset_heights *heights, double width_mm,
                                 double height_mm, weft_error *error);

/* Its normals as a picture, a pixel a place: (n + 1) / 2 as red, green, blue with x to the right, y up and z toward the
 * viewer, not gamma-coded. The material repeats. Errors: WEFT_SYSTEM. */
weft_code weft_surface_write_normals(const char *path, const weft_dataset_heights *heights, double width_mm,
                                     double height_mm, weft_error *error);

#endif
