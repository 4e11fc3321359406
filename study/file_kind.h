/* What a file of Weft is, by its name. */
#ifndef WEFT_STUDY_FILE_KIND_H
#define WEFT_STUDY_FILE_KIND_H

#include "btf/status.h"

typedef enum weft_file_kind {
    WEFT_FILE_SESSION,       /* a folder */
    WEFT_FILE_DATASET,       /* NAME.btf.h5 */
    WEFT_FILE_MATERIAL,      /* NAME.weft */
    WEFT_FILE_WEAVE,         /* NAME.wv */
    WEFT_FILE_MICROCYLINDER, /* NAME.mc */
    WEFT_FILE_STITCH         /* NAME.stitch */
} weft_file_kind;

/* Errors: WEFT_BAD_INPUT where there is no such file, or its name has none of these endings. */
weft_code weft_file_kind_of(const char *path, weft_file_kind *kind, weft_error *error);

#endif
