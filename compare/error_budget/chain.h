/* From virtual cloth to a file, as a user would do it, but without heights: photographs, dataset, material. */
#ifndef WEFT_COMPARE_ERROR_BUDGET_CHAIN_H
#define WEFT_COMPARE_ERROR_BUDGET_CHAIN_H

#include "base/progress.h"
#include "capture/virtual/virtual_rig.h"

#include <limits.h>

typedef struct weft_chain_request {
    const char *plan;    /* capture/plan.h */
    int size;            /* texels along a side */
    int component_count; /* of the material, at most 32; WEFT_COMPONENTS_AUTOMATIC as weft compress chooses */
} weft_chain_request;

/* What was made: files in a folder. */
typedef struct weft_chain {
    char session[PATH_MAX], registered[PATH_MAX], fitted[PATH_MAX], stored[PATH_MAX];
    int photograph_count, registered_count, component_count;
} weft_chain;

/* Takes the photographs with an open rig, registers them, and fits components twice: once with coefficients of 15 bits,
 * for `fitted`, and once of 8 bits as weft compress does, for `stored`. The photographs are removed once they are
 * registered. The caller removes the rest with weft_chain_remove, also after a failure. Errors: those of the stages. */
weft_code weft_chain_make(const weft_chain_request *request, weft_virtual_rig *rig, const char *folder,
                          const weft_progress *progress, weft_chain *chain, weft_error *error);
void weft_chain_remove(const weft_chain *chain);

#endif
