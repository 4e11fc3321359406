/* Which photographs of a dataset to show. */
#ifndef WEFT_STUDY_COMPARE_REPRESENTATIVE_H
#define WEFT_STUDY_COMPARE_REPRESENTATIVE_H

#include "btf/dataset/dataset.h"

enum { WEFT_REPRESENTATIVE_COUNT = 4 };

/* For views at theta 0, 30, 60 and 75 degrees the image nearest to such a view with a light 30 degrees from the normal
 * and a quarter turn aside. Each image once: returns how many were found, in image [WEFT_REPRESENTATIVE_COUNT].
 * Directions as the centre of the material sees them. Pure. */
int weft_representative_images(const weft_dataset_layout *layout, int image[WEFT_REPRESENTATIVE_COUNT]);

/* Angles of light and view of an image at the centre of the material, degrees. Pure. */
typedef struct weft_image_angles {
    double theta_light_deg, phi_light_deg, theta_view_deg, phi_view_deg;
} weft_image_angles;
weft_image_angles weft_image_angles_of(const weft_dataset_layout *layout, int image);

#endif
