/* Light on the sensor: every pixel is the mean over its area and over the pupil, by as many rays as it needs. */
#ifndef WEFT_CAPTURE_SYNTHETIC_RENDER_H
#define WEFT_CAPTURE_SYNTHETIC_RENDER_H

#include "capture/synthetic/lens.h"
#include "capture/synthetic/scene.h"

/* radiance [height][width][3]: cd/m^2 times colour, times the vignetting of the lens. `seed` scatters the rays. Where
 * the picture of the plane is even over what a pixel sees, one evaluation is its mean; elsewhere rays are traced. The
 * same for any number of threads. Parallel. */
void weft_synthetic_render(const weft_synthetic_lens *lens, const weft_pose *pose, const weft_synthetic_scene *scene,
                           uint64_t seed, float *radiance);

#endif
