/* Synthetic photographs of a printed sheet, as a camera, a lamp and bad luck would give them, with their truth. They
 * stand in for hardware. */
#ifndef WEFT_CAPTURE_SYNTHETIC_SYNTHETIC_H
#define WEFT_CAPTURE_SYNTHETIC_SYNTHETIC_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "capture/synthetic/plan.h"

/* One photograph as the file holds it, 0..1; the caller frees it. Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_synthetic_take(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                              const weft_synthetic_content *content, weft_image *image, weft_error *error);

/* Writes all photographs into the folder of the request, and the truth beside it: FOLDER.truth.json and, for a
 * truth_size above 0, FOLDER.truth.btf.h5; FOLDER.lp for a tripod and FOLDER.steps.csv for a table. The same request
 * gives the same bytes, for any number of threads. `warning` as weft_synthetic_content_read. Errors: WEFT_BAD_USAGE for
 * a folder that holds something; those of weft_synthetic_content_read; WEFT_SYSTEM. */
weft_code weft_synthetic_run(const weft_synthetic_request *request, const weft_progress *progress,
                             char warning[WEFT_MESSAGE_SIZE], weft_error *error);

#endif
