/* Where the error of a material comes from, on virtual cloth whose reflectance is known everywhere
 * (docs/guide/truth.md). */
#ifndef WEFT_COMPARE_ERROR_BUDGET_SOURCES_H
#define WEFT_COMPARE_ERROR_BUDGET_SOURCES_H

#include "capture/virtual/virtual_settings.h"
#include "compare/error_budget/chain.h"
#include "compare/error_budget/measure.h"

#include <jansson.h>

typedef struct weft_sources_request {
    weft_virtual_settings rig;
    double tiles; /* of a stitch across the opening; opening, lens and errors of places are scaled; 0: as they are */
    weft_chain_request chain;
    weft_source_queries queries; /* its seed is that of the rig, too */
    const char *folder;          /* for files that are gone in the end */
} weft_sources_request;

/* Of one cloth. */
typedef struct weft_sources {
    char name[128];    /* that the file gives the cloth */
    double opening_mm; /* that was photographed */
    int photograph_count, registered_count, size, component_count;
    weft_source_span span;
    weft_error_stack stack;
} weft_sources;

/* Photographs the weave or stitch `cloth` virtually, registers and compresses it, and splits the error of the material
 * against the cloth itself. Makes the folder. The same request gives the same result, for any number of threads.
 * Errors: those of the stages; WEFT_BAD_USAGE where no query can be answered. */
weft_code weft_sources_measure(const weft_sources_request *request, const char *cloth, const weft_progress *progress,
                               weft_sources *result, weft_error *error);

/* The result as JSON. The caller owns it; NULL where memory is short. */
json_t *weft_sources_to_json(const weft_sources *sources);

/* Writes a table of comma-separated values, a row for each cloth and source, atomically. Errors: WEFT_SYSTEM. */
weft_code weft_sources_write_csv(const weft_sources *sources, int count, const char *path, weft_error *error);

/* Writes folder/index.html with one stack for each cloth. Errors: WEFT_SYSTEM. */
weft_code weft_sources_write_page(const weft_sources *sources, int count, const weft_sources_request *request,
                                  weft_error *error);

#endif
