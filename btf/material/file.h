/* NAME.weft as bytes (docs/reference/weft-format.md): header and table of sections, and which sections a version of the
 * format has. Shared by the readers and the writer. Private to btf/material. */
#ifndef WEFT_BTF_MATERIAL_FILE_H
#define WEFT_BTF_MATERIAL_FILE_H

#include "btf/material/material.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "arrays are stored as they lie in memory");

enum {
    WEFT_FORMAT_VERSION = 2, /* that is written */
    WEFT_FORMAT_HEADER_SIZE = 64,
    WEFT_FORMAT_ENTRY_SIZE = 40,
    WEFT_FORMAT_ALIGNMENT = 64,
    WEFT_FORMAT_MAX_SECTIONS = 4096,
    WEFT_FORMAT_MAX_KINDS = 20,
    WEFT_FORMAT_MAX_METADATA = 1 << 24,
    WEFT_FORMAT_PLAIN_METADATA = 4096, /* bytes that are never compressed */
    WEFT_FORMAT_MAX_RATIO = 1024,      /* a section decodes to at most MAX_RATIO x stored + FREE_RATIO bytes */
    WEFT_FORMAT_FREE_RATIO = 1 << 16,
    WEFT_FORMAT_ERRORS = 5 /* numbers that say how well a level was fitted */
};

/* What a file of version 2 holds. A reader refuses a file with an unknown feature below WEFT_FEATURE_OPTIONAL, and
 * ignores the others that it does not know. */
enum {
    WEFT_FEATURE_LOBES = 1 << 0,
    WEFT_FEATURE_COMPONENTS = 1 << 1,
    WEFT_FEATURE_VIEWS = 1 << 2, /* directions: of the view table, where there are lobes, and of the opacity */
    WEFT_FEATURE_OPACITY = 1 << 3,
    WEFT_FEATURE_OPTIONAL = 1 << 16,
    WEFT_FEATURE_HEIGHTS = 1 << 16,
    WEFT_FEATURE_VISIBILITY = 1 << 17
};

typedef enum weft_codec {
    WEFT_CODEC_NONE,
    WEFT_CODEC_ZSTD,
    WEFT_CODEC_DIFFERENCES, /* of version 1, LAYR alone: Zstandard, with its values by differences */
    WEFT_CODEC_WEIGHTED     /* the same with the weights of what they are predicted from */
} weft_codec;

/* One entry of the section table. */
typedef struct weft_section {
    char type[5]; /* NUL-terminated */
    uint32_t level, codec, checksum;
    uint64_t offset, stored_size, decoded_size;
} weft_section;

typedef struct weft_material_file weft_material_file;

/* A section as it is read. */
typedef struct weft_section_reading {
    weft_material_file *file;
    weft_material *material; /* its arrays are allocated */
    const weft_section *section;
    const uint8_t *bytes; /* decoded */
    const char *fault;    /* receives what is wrong with them ("holds ..."); else NULL */
} weft_section_reading;

/* Takes the bytes into the material. Errors: WEFT_BAD_INPUT where something is wrong with them, WEFT_SYSTEM. */
typedef weft_code weft_section_load(weft_section_reading *r, weft_error *error);

/* Numbers in memory that a section holds: `count` pieces of `bytes`, each `stride` behind the one before, the first
 * `offset` behind `base`. */
typedef struct weft_section_array {
    void *base; /* NULL until it is allocated */
    size_t offset, count, bytes, stride;
} weft_section_array;

/* What is wrong with the decoded bytes of a section ("holds ..."), or NULL. Pure. */
typedef const char *weft_section_fault(const weft_material *material, int level, const uint8_t *bytes, size_t size);

/* A kind of section. Kinds are read in the order of their list. */
typedef struct weft_section_kind {
    char type[5];
    bool of_levels;   /* there is one of each level; else one of level 0 */
    uint32_t needs;   /* features that it is there with: all of them */
    uint32_t bars;    /* and none of these */
    uint32_t reveals; /* version 1 has no features in its header: this kind of section shows that they are there */
    bool is_free;     /* of no size that the header tells; what loads it checks */
    weft_section_array (*array)(const weft_material *material, int level); /* in place of size, load and store */
    uint64_t (*size)(const weft_material *material, int level);
    /* In place of the size alone, before anything is allocated: what is wrong with it, or NULL. */
    const char *(*check)(const weft_material_file *file, const weft_material *material, const weft_section *section);
    weft_section_fault *fault; /* NULL: none can be, or `load` finds it */
    weft_section_load *load;
    void (*store)(const weft_material *material, int level, uint8_t *bytes); /* to bytes [size]; version 2 */
} weft_section_kind;

/* A file in memory. */
struct weft_material_file {
    const char *path;
    unsigned char *bytes; /* [size] */
    size_t size;
    uint32_t version, features;
    int component_count; /* of version 2 */
    int kind_count;
    const weft_section_kind *kind; /* [kind_count] */
    int section_count;
    weft_section *section;                                      /* [section_count] */
    int found[WEFT_FORMAT_MAX_KINDS][WEFT_MATERIAL_MAX_LEVELS]; /* index + 1 of the section, 0: none */
    uint8_t *model[WEFT_MATERIAL_MAX_LEVELS];                   /* of version 1: which parts each texel has */
};

extern const unsigned char weft_format_magic[8];

/* The kinds of version 2. */
enum { WEFT_FORMAT_KINDS = 12 };
extern const weft_section_kind weft_sections_of_version_2[WEFT_FORMAT_KINDS];

/* Checks header, table, places, sizes and checksums of file->bytes and sets the shape of `material`; nothing of it is
 * allocated yet. Frees nothing on failure. Errors: WEFT_BAD_INPUT names file and section; WEFT_SYSTEM. */
weft_code weft_material_file_open(weft_material_file *file, weft_material *material, weft_error *error);

/* Reads file->path before. */
weft_code weft_material_file_load(weft_material_file *file, weft_error *error);
void weft_material_file_free(weft_material_file *file);

/* Of version 1: its kinds, and the features that the counts in its header show. Errors: WEFT_BAD_INPUT. */
weft_code weft_read_features_of_version_1(weft_material_file *file, weft_error *error);

/* Whether a file of these features has sections of a kind. Pure. */
bool weft_section_is_there(const weft_section_kind *kind, uint32_t features);

/* Number of sections of a kind that is there. Pure. */
int weft_section_levels(const weft_section_kind *kind, const weft_material *material);

/* Decoded bytes of a section of a kind that is not free. Pure. */
uint64_t weft_section_size(const weft_section_kind *kind, const weft_material *material, int level);

/* The section of a kind, by its index, and level; it must have been found. */
static inline const weft_section *weft_file_section(const weft_material_file *file, int kind, int level)
{
    return &file->section[file->found[kind][level] - 1];
}

/* Sets the error "section ... of level ...: what" and returns WEFT_BAD_INPUT. */
weft_code weft_fail_section(const weft_material_file *file, const weft_section *section, weft_error *error,
                            const char *what);

/* What a material would be in a file. Pure, but for opacity: looks through the table. */
uint32_t weft_material_features(const weft_material *material);

/* Checks the counts and sets the sizes of all levels; allocates nothing. level_count 0 asks for the full chain.
 * Errors: WEFT_BAD_USAGE naming the number out of range. */
weft_code weft_material_set_shape(weft_material *material, int width, int height, int level_count, int lobe_count,
                                  int view_count, int light_count, weft_error *error);

/* Allocates the arrays of a material whose shape is set: those of lobes where it has_lobes. On failure everything is
 * freed. Errors: WEFT_SYSTEM. */
weft_code weft_material_allocate(weft_material *material, weft_error *error);

/* ---- What both versions have ---- */

uint64_t weft_size_of_views(const weft_material *material, int level);
size_t weft_texel_count(const weft_material *material, int level);

const char *weft_check_metadata(const weft_material_file *file, const weft_material *material,
                                const weft_section *section);

weft_section_load weft_load_metadata, weft_load_views, weft_load_heights, weft_load_visibility;
weft_section_fault weft_fault_of_errors, weft_fault_of_directions, weft_fault_of_coefficients;

weft_section_array weft_array_of_frames(const weft_material *material, int level);
weft_section_array weft_array_of_opacity(const weft_material *material, int level);
weft_section_array weft_array_of_coefficients(const weft_material *material, int level);

/* What is wrong with half floats, of which every fourth, or all of them, must not be negative; NULL: nothing. Pure. */
const char *weft_fault_of_halves(const uint8_t *bytes, size_t size, bool all_positive);

/* Errors of a level from f64 [WEFT_FORMAT_ERRORS]. Pure. */
weft_error_summary weft_take_errors(const uint8_t *bytes);

/* Directions from f32 [count][3]. */
void weft_take_directions(const uint8_t *bytes, int count, weft_vec3 *direction);

#endif
