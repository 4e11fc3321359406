/* The parts of the page of weft_compare. */
#ifndef WEFT_COMPARE_REPORT_PAGE_SECTIONS_H
#define WEFT_COMPARE_REPORT_PAGE_SECTIONS_H

#include "base/text/html_page.h"
#include "compare/report/compare.h"

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

/* The few numbers that matter most, and what the dataset is. */
void weft_page_summary(weft_page *page, const weft_dataset_layout *layout, const weft_comparison *comparison);

/* The errors of every model against the data, of the samples and of the mean BRDF. */
void weft_page_models(weft_page *page, const weft_comparison *comparison);

/* A row of hemispheres for the data and for each model; writes slices.csv and slices-ROW.png. */
weft_code weft_page_slices(weft_page *page, const weft_slices *slices, weft_error *error);

/* Error of the levels as stored, error over all and by ring as measured, sizes, times, masks. Errors: WEFT_SYSTEM. */
weft_code weft_page_numbers(weft_page *page, const weft_dataset_layout *layout, const weft_material *material,
                            const weft_comparison *comparison, weft_error *error);

/* Every scene in every mode, and the differences to the dataset. Errors: WEFT_SYSTEM from writing pictures. */
weft_code weft_page_scenes(weft_page *page, const weft_scenes *scenes, weft_error *error);

/* The drape of the geometry itself beside the dataset and the material; nothing without a stitch. Errors: WEFT_SYSTEM
 * from writing pictures. */
weft_code weft_page_truth(weft_page *page, const weft_traced_truth *truth, weft_error *error);

/* A few photographs, flat, with the prediction of every model and its difference. Errors: WEFT_SYSTEM from writing
 * pictures. */
weft_code weft_page_pairs(weft_page *page, const weft_dataset_layout *layout, const weft_comparison *comparison,
                          weft_error *error);

#endif
