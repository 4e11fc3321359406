/* The drape as a BTF without fault would show it: for every path the flat, endless stitch is traced at the very place
 * where the ray meets the mesh, for the view and the light that are in the axes of the cloth there. It goes on through
 * holes, to the eye and to the light. */
#ifndef WEFT_BENCH_FAULTLESS_BTF_H
#define WEFT_BENCH_FAULTLESS_BTF_H

#include "base/picture/image.h"
#include "geometry/light/stitch_sample.h"
#include "player/mesh/mesh.h"
#include "player/scene/scene.h"

typedef struct faultless_btf {
    const weft_stitch_sample *sample;
    const weft_mesh *mesh; /* its unit of coordinates is mm_per_unit of the stitch */
    double mm_per_unit;
    double plane_mm; /* of the mesh, above the top of the stitch */
} faultless_btf;

/* As large as `background`, which open places show. The caller frees it. Ends the program where memory is short. */
weft_image faultless_btf_draw(const faultless_btf *of, const weft_scene *scene, int paths,
                              const weft_image *background);

#endif
