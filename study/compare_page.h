/* The parts of the page of weft_compare. */
#ifndef WEFT_STUDY_COMPARE_PAGE_H
#define WEFT_STUDY_COMPARE_PAGE_H

#include "study/compare.h"
#include "study/page.h"

/* The few numbers that matter most, and what the dataset is. */
void weft_page_summary(weft_page *page, const weft_dataset_layout *layout, const weft_comparison *comparison);

/* Error of the levels as stored, error over all and by ring as measured, sizes, times, masks. */
void weft_page_numbers(weft_page *page, const weft_dataset_layout *layout, const weft_material *material,
                       const weft_comparison *comparison);

/* Every scene in every mode, and the differences to the dataset. Errors: WEFT_SYSTEM from writing pictures. */
weft_code weft_page_scenes(weft_page *page, const weft_scenes *scenes, weft_error *error);

/* Sample, prediction and difference of every pair, flat. Errors: WEFT_SYSTEM from writing pictures. */
weft_code weft_page_pairs(weft_page *page, const weft_dataset_layout *layout, const weft_measurement *measurement,
                          weft_error *error);

/* Photograph, prediction and difference of every photograph left out, and the table of their errors. */
weft_code weft_page_left_out(weft_page *page, const weft_leave_one_out *left_out, weft_error *error);

/* One row: sample, prediction, difference under one exposure. `name` begins the names of the files. */
weft_code weft_page_pair(weft_page *page, const char *name, const weft_image_pair *pair, const char *caption,
                         weft_error *error);

#endif
