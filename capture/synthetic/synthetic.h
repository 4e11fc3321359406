/* Synthetic photographs of a printed sheet, as a camera, a lamp and bad luck would give them, with their truth. They
 * stand in for hardware. */
#ifndef WEFT_CAPTURE_SYNTHETIC_SYNTHETIC_H
#define WEFT_CAPTURE_SYNTHETIC_SYNTHETIC_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "capture/synthetic/plan.h"

#include <limits.h>

/* One photograph as the file holds it, 0..1; the caller frees it. Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_synthetic_take(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                              const weft_virtual_sample *content, weft_image *image, weft_error *error);

/* Writes all photographs into the folder of the request, and the truth beside it: FOLDER.truth.json and, for a
 * truth_size above 0, FOLDER.truth.btf.h5; FOLDER.lp for a tripod and FOLDER.steps.csv for a table. The same request
 * gives the same bytes, for any number of threads. `warning` as weft_virtual_sample_read. Errors: WEFT_BAD_USAGE for
 * a folder that holds something; those of weft_virtual_sample_read; WEFT_SYSTEM. */
weft_code weft_synthetic_run(const weft_synthetic_request *request, const weft_progress *progress,
                             char warning[WEFT_MESSAGE_SIZE], weft_error *error);

/* ---- The truth beside a folder of photographs: what registration must find, in files that it never reads. ---- */

/* FOLDER.truth.json: docs/reference/synthetic.md. Errors: WEFT_SYSTEM. */
weft_code weft_synthetic_truth_write(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                     weft_error *error);

/* FOLDER.truth.btf.h5: the true reflectance of the content under the lamp and the camera of every photograph, as near
 * positions; the images of rubbish are masked. Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_synthetic_truth_write_reflectance(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                                 const weft_virtual_sample *content, const weft_progress *progress,
                                                 weft_error *error);

/* What a person would note down. Of a tripod FOLDER.lp: the number of photographs, then a line for each, its name and
 * the direction of the lamp from the middle of the sheet, in the frame of the sheet (as Polynomial Texture Mapping has
 * it). Of a table FOLDER.steps.csv: name, theta_deg and phi_deg of the view as the table says. Nothing else. Errors:
 * WEFT_SYSTEM. */
weft_code weft_synthetic_write_notes(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                     weft_error *error);

#endif
