/* What a file of Weft is. */
#ifndef WEFT_BTF_FILE_KIND_H
#define WEFT_BTF_FILE_KIND_H

#include "base/status.h"

#include <stdbool.h>

typedef enum weft_file_kind {
    WEFT_FILE_SESSION,       /* a folder */
    WEFT_FILE_DATASET,       /* NAME.btf.h5 */
    WEFT_FILE_MATERIAL,      /* NAME.weft */
    WEFT_FILE_WEAVE,         /* NAME.wv */
    WEFT_FILE_MICROCYLINDER, /* NAME.mc */
    WEFT_FILE_STITCH,        /* NAME.stitch */
    WEFT_FILE_MESH,          /* NAME.obj */
    WEFT_FILE_RADIANCE,      /* a picture of floats: .exr, .hdr */
    WEFT_FILE_PICTURE        /* .png */
} weft_file_kind;

/* By the first bytes, or the first word that is no comment; where they say nothing, by the name, so that whoever reads
 * the file can say what is wrong in it. Errors: WEFT_BAD_INPUT where there is no such file, or neither says it. */
weft_code weft_file_kind_of(const char *path, weft_file_kind *kind, weft_error *error);

/* Whether a regular file begins as the binary BTF files of the University of Bonn do, of which `weft import` makes
 * datasets. */
bool weft_file_is_bonn(const char *path);

#endif
