#include "base/picture/container.h"

#include "base/atomic_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* A file that is read by places. A place beyond its end reads as a failure, never as zeros. */
typedef struct source {
    FILE *file;
    const char *path;
    uint64_t size;
    bool big_endian;
    weft_error *error;
} source;

static weft_code damaged(const source *s, const char *why)
{
    return weft_fail(s->error, WEFT_DAMAGED, "image '%s' is not whole: %s", s->path, why);
}

static bool holds(const source *s, uint64_t place, uint64_t count)
{
    return place <= s->size && count <= s->size - place;
}

static weft_code fetch(const source *s, uint64_t place, void *bytes, size_t count)
{
    if (!holds(s, place, count))
        return damaged(s, "it ends too early");
    if (fseeko(s->file, (off_t)place, SEEK_SET) != 0 || fread(bytes, 1, count, s->file) != count)
        return damaged(s, "it cannot be read to its end");
    return WEFT_OK;
}

static uint64_t number_of(const source *s, const uint8_t *byte, size_t count)
{
    uint64_t value = 0;
    for (size_t i = 0; i < count; i++)
        value |= (uint64_t)byte[i] << 8 * (s->big_endian ? count - 1 - i : i);
    return value;
}

static weft_code fetch_number(const source *s, uint64_t place, size_t bytes, uint64_t *value)
{
    uint8_t byte[8];
    WEFT_TRY(fetch(s, place, byte, bytes));
    *value = number_of(s, byte, bytes);
    return WEFT_OK;
}

/* ---- PNG ---- */

typedef struct chunk {
    uint64_t place; /* of its data */
    uint32_t size;
    char type[5];
} chunk;

static bool has_checksum(const source *s, const chunk *c)
{
    uint8_t block[16384];
    uint64_t said, left = (uint64_t)c->size + 4, place = c->place - 4;
    uLong sum = crc32(0, NULL, 0);
    for (size_t count; left > 0; left -= count, place += count) {
        count = left < sizeof block ? (size_t)left : sizeof block;
        if (fetch(s, place, block, count) != WEFT_OK)
            return false;
        sum = crc32(sum, block, (uInt)count);
    }
    return fetch_number(s, place, 4, &said) == WEFT_OK && said == sum;
}

/* A damaged chunk of colours is passed over, as if it were not there. */
static weft_code read_colour_chunk(const source *s, const chunk *c, weft_colour_tags *tags)
{
    const double unit = 1e-5;
    uint8_t data[32];
    if (c->size > sizeof data || !strstr("cICP sRGB gAMA cHRM", c->type) || !has_checksum(s, c))
        return WEFT_OK;
    WEFT_TRY(fetch(s, c->place, data, c->size));
    if (strcmp(c->type, "cICP") == 0 && c->size == 4) {
        tags->has_cicp = true;
        memcpy(tags->cicp, data, 4);
    } else if (strcmp(c->type, "sRGB") == 0 && c->size == 1) {
        tags->says_srgb = true;
    } else if (strcmp(c->type, "gAMA") == 0 && c->size == 4) {
        double encoding = unit * (double)number_of(s, data, 4);
        tags->gamma = encoding > 0 ? 1 / encoding : 0;
    } else if (strcmp(c->type, "cHRM") == 0 && c->size == 32) {
        static const int white_last[4] = {3, 0, 1, 2};
        tags->has_primaries = true;
        for (int i = 0; i < 8; i++)
            tags->primaries[2 * white_last[i / 2] + i % 2] = unit * (double)number_of(s, data + 4 * i, 4);
    }
    return WEFT_OK;
}

static weft_code read_png(source *s, weft_colour_tags *tags)
{
    enum { SIGNATURE_BYTES = 8, CRITICAL = 0x20 };
    bool has_pixels = false;
    chunk c = {.type = ""};
    s->big_endian = true;
    for (uint64_t place = SIGNATURE_BYTES; strcmp(c.type, "IEND") != 0; place = c.place + c.size + 4) {
        uint8_t head[8];
        WEFT_TRY(fetch(s, place, head, sizeof head));
        c.place = place + sizeof head;
        c.size = (uint32_t)number_of(s, head, 4);
        memcpy(c.type, head + 4, 4);
        if (!holds(s, c.place, (uint64_t)c.size + 4))
            return damaged(s, "it ends too early");
        if (!(c.type[0] & CRITICAL) && !has_checksum(s, &c))
            return damaged(s, "a part of it fails its checksum");
        has_pixels = has_pixels || strcmp(c.type, "IDAT") == 0;
        WEFT_TRY(read_colour_chunk(s, &c, tags));
    }
    return has_pixels ? WEFT_OK : damaged(s, "it has no pixels");
}

/* ---- JPEG ---- */

enum { END_OF_IMAGE = 0xd9 };

/* What the data of a JPEG hold, from its first scan on. */
typedef struct scans {
    int count;
    size_t zeros; /* in the longest run of the first scan */
} scans;

static weft_code read_scans(const source *s, uint64_t place, scans *found)
{
    enum { START_OF_SCAN = 0xda, FIRST_RESTART = 0xd0, LAST_RESTART = 0xd7 };
    uint8_t block[16384], last = 1;
    size_t zeros = 0;
    *found = (scans){.count = 1};
    for (size_t count; place < s->size; place += count) {
        count = s->size - place < sizeof block ? (size_t)(s->size - place) : sizeof block;
        WEFT_TRY(fetch(s, place, block, count));
        for (size_t i = 0; i < count; last = block[i++]) {
            zeros = block[i] ? 0 : zeros + 1;
            if (found->count == 1 && zeros > found->zeros)
                found->zeros = zeros;
            bool is_marker = last == 0xff && block[i] != 0 && (block[i] < FIRST_RESTART || block[i] > LAST_RESTART);
            found->count += is_marker && block[i] == START_OF_SCAN;
            if (is_marker && block[i] == END_OF_IMAGE)
                return WEFT_OK;
        }
    }
    return WEFT_OK;
}

/* Whether a symbol other than 0 has the code of nothing but zeros in one of the tables of a DHT segment. Where 0 has it
 * in all of them, zeros are a flat area. */
static weft_code read_tables(const source *s, uint64_t place, uint64_t end, bool *has_other)
{
    enum { LENGTHS = 16 };
    while (place + 1 + LENGTHS < end) {
        uint8_t head[1 + LENGTHS + 1];
        uint64_t symbols = 0;
        WEFT_TRY(fetch(s, place, head, sizeof head));
        for (int i = 1; i <= LENGTHS; i++)
            symbols += head[i];
        *has_other = *has_other || head[1 + LENGTHS] != 0;
        place += 1 + LENGTHS + symbols;
    }
    return WEFT_OK;
}

/* A cluster of a disk that was never written is all zeros. Usual codes of Huffman leave no such run in a sequential
 * JPEG, but a decoder does not mind one; progressive ones may well refine by zeros. Each scan of a progressive one
 * costs as much as the picture is large, however short it is. The decoder finds other damage. */
static weft_code read_jpeg(source *s)
{
    enum { BASELINE = 0xc0, EXTENDED = 0xc1, TABLES = 0xc4, START_OF_SCAN = 0xda, MOST_ZEROS = 127, MOST_SCANS = 200 };
    bool is_sequential = false, has_other = false;
    scans found = {0};
    s->big_endian = true;
    for (uint64_t place = 2; found.count == 0 && holds(s, place, 4);) {
        uint8_t head[4];
        WEFT_TRY(fetch(s, place, head, sizeof head));
        if (head[0] != 0xff)
            return WEFT_OK;
        if (head[1] == TABLES)
            WEFT_TRY(read_tables(s, place + 4, place + 2 + number_of(s, head + 2, 2), &has_other));
        place += 2 + number_of(s, head + 2, 2);
        is_sequential = is_sequential || head[1] == BASELINE || head[1] == EXTENDED;
        if (head[1] == START_OF_SCAN)
            WEFT_TRY(read_scans(s, place, &found));
    }
    if (is_sequential && has_other && found.zeros > MOST_ZEROS)
        return damaged(s, "a part of its data was replaced by zeros");
    return found.count <= MOST_SCANS ? WEFT_OK : damaged(s, "it has more scans than any picture needs");
}

/* ---- TIFF ---- */

enum {
    SUBFILE_TYPE = 254,
    IMAGE_WIDTH = 256,
    IMAGE_LENGTH = 257,
    PHOTOMETRIC = 262,
    STRIP_OFFSETS = 273,
    STRIP_COUNTS = 279,
    TILE_OFFSETS = 324,
    TILE_COUNTS = 325,
    SUB_DIRECTORIES = 330,
    DNG_VERSION = 50706,
    COLOUR_FILTERS = 32803, /* photometric */
    LINEAR_RAW = 34892,
    MOST_DIRECTORIES = 32,
    MOST_PIXELS_IN_BYTE = 32 /* of a sensor: its noise cannot be packed */
};

/* Values of an entry: `count` numbers of `bytes` each. */
typedef struct values {
    uint64_t place, count;
    size_t bytes;
} values;

/* Of a directory. */
typedef struct directory {
    bool is_reduced;
    uint64_t photometric, width, height;
    bool is_dng;
    values offsets, counts, below;
    uint64_t next;
} directory;

typedef struct tiff {
    source *s;
    bool is_big; /* BigTIFF */
    bool is_raw, has_all_in_chain;
    int directories;
} tiff;

static size_t bytes_of_type(uint64_t type)
{
    static const uint8_t bytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
    return type < sizeof bytes ? bytes[type] : 0;
}

static weft_code value_at(const tiff *t, const values *v, uint64_t index, uint64_t *value)
{
    return fetch_number(t->s, v->place + index * v->bytes, v->bytes, value);
}

static weft_code read_entry(const tiff *t, uint64_t place, directory *d)
{
    size_t word = t->is_big ? 8 : 4;
    uint64_t tag, type, value;
    values v;
    WEFT_TRY(fetch_number(t->s, place, 2, &tag));
    WEFT_TRY(fetch_number(t->s, place + 2, 2, &type));
    WEFT_TRY(fetch_number(t->s, place + 4, word, &v.count));
    v.bytes = bytes_of_type(type);
    v.place = place + 4 + word;
    if (v.bytes == 0 || v.count == 0)
        return WEFT_OK;
    if (v.count > word / v.bytes)
        WEFT_TRY(fetch_number(t->s, v.place, word, &v.place));
    if (tag == STRIP_OFFSETS || tag == TILE_OFFSETS)
        d->offsets = v;
    else if (tag == STRIP_COUNTS || tag == TILE_COUNTS)
        d->counts = v;
    else if (tag == SUB_DIRECTORIES)
        d->below = v;
    else if (tag == DNG_VERSION)
        d->is_dng = true;
    if (tag != SUBFILE_TYPE && tag != PHOTOMETRIC && tag != IMAGE_WIDTH && tag != IMAGE_LENGTH)
        return WEFT_OK;
    WEFT_TRY(value_at(t, &v, 0, &value));
    if (tag == PHOTOMETRIC)
        d->photometric = value;
    else if (tag == SUBFILE_TYPE)
        d->is_reduced = value & 1;
    else
        *(tag == IMAGE_WIDTH ? &d->width : &d->height) = value;
    return WEFT_OK;
}

static weft_code read_directory(const tiff *t, uint64_t place, directory *d)
{
    size_t count_bytes = t->is_big ? 8 : 2, entry_bytes = t->is_big ? 20 : 12;
    uint64_t count;
    *d = (directory){.photometric = 0};
    WEFT_TRY(fetch_number(t->s, place, count_bytes, &count));
    if (!holds(t->s, place, count) || !holds(t->s, place + count_bytes, count * entry_bytes))
        return damaged(t->s, "it ends too early");
    for (uint64_t i = 0; i < count; i++)
        WEFT_TRY(read_entry(t, place + count_bytes + i * entry_bytes, d));
    uint64_t end = place + count_bytes + count * entry_bytes;
    /* Some files end without the place of a next directory. */
    if (holds(t->s, end, t->is_big ? 8 : 4))
        WEFT_TRY(fetch_number(t->s, end, t->is_big ? 8 : 4, &d->next));
    return WEFT_OK;
}

/* RW2 says elsewhere where its pixels are. */
static bool is_unsaid(uint64_t offset)
{
    return offset == UINT32_MAX;
}

/* Whether the middle of a block is one byte over and over: programs that drop pixels and keep their place write zeros.
 */
static bool is_blank(const source *s, uint64_t offset, uint64_t count)
{
    uint8_t sample[4096];
    if (count < sizeof sample || fetch(s, offset + (count - sizeof sample) / 2, sample, sizeof sample) != WEFT_OK)
        return false;
    return memcmp(sample, sample + 1, sizeof sample - 1) == 0;
}

static weft_code check_pixels(const tiff *t, const directory *d)
{
    uint64_t missing = 0, blank = 0, bytes = 0, offset, count;
    if (d->offsets.count == 0 || d->offsets.count != d->counts.count)
        return WEFT_OK;
    if (!holds(t->s, d->offsets.place, d->offsets.count))
        return damaged(t->s, "it ends too early");
    for (uint64_t i = 0; i < d->offsets.count; i++) {
        WEFT_TRY(value_at(t, &d->offsets, i, &offset));
        WEFT_TRY(value_at(t, &d->counts, i, &count));
        missing += !is_unsaid(offset) && (offset == 0 || count == 0 || !holds(t->s, offset, count));
        bytes += count;
        /* One that is not ends the search. */
        blank += t->is_raw && blank == i && is_blank(t->s, offset, count);
    }
    if (t->is_raw && d->width < UINT32_MAX && d->height < UINT32_MAX &&
        d->width * d->height / MOST_PIXELS_IN_BYTE > bytes)
        return weft_fail(t->s->error, WEFT_DAMAGED,
                         "image '%s' is not whole: %" PRIu64 " bytes cannot hold %" PRIu64 " x %" PRIu64 " pixels",
                         t->s->path, bytes, d->width, d->height);
    if (blank == d->offsets.count)
        return damaged(t->s, "it holds no values of a sensor");
    if (missing == 0)
        return WEFT_OK;
    return weft_fail(t->s->error, WEFT_DAMAGED,
                     "image '%s' is not whole: of %" PRIu64 " blocks of its pixels %" PRIu64
                     " are missing or end too early (the file has %" PRIu64 " bytes)",
                     t->s->path, d->offsets.count, missing, t->s->size);
}

/* A reduced picture, which is a preview, may lack what it likes. */
static weft_code visit_directory(tiff *t, uint64_t place, directory *d)
{
    if (++t->directories > MOST_DIRECTORIES)
        return damaged(t->s, "it has too many directories");
    WEFT_TRY(read_directory(t, place, d));
    t->is_raw = t->is_raw || d->is_dng || d->photometric == COLOUR_FILTERS || d->photometric == LINEAR_RAW;
    return d->is_reduced ? WEFT_OK : check_pixels(t, d);
}

/* The first directory and those below it; of CR2 also those that follow, for the last one holds the pixels. */
static weft_code read_directories(tiff *t, uint64_t place)
{
    for (uint64_t at = place; at != 0;) {
        directory d, below;
        uint64_t sub;
        WEFT_TRY(visit_directory(t, at, &d));
        for (uint64_t i = 0; i < d.below.count; i++) {
            WEFT_TRY(value_at(t, &d.below, i, &sub));
            WEFT_TRY(visit_directory(t, sub, &below));
        }
        at = t->has_all_in_chain ? d.next : 0;
    }
    return WEFT_OK;
}

/* Whether the bytes begin a TIFF, or a raw file that is built as one. */
static bool is_tiff(const uint8_t head[16], tiff *t)
{
    static const char *const raw[] = {"IIRO", "IIRS", "MMOR", "IIU\0"};
    uint8_t mark = head[head[0] == 'M' ? 3 : 2];
    if (memcmp(head, "II", 2) != 0 && memcmp(head, "MM", 2) != 0)
        return false;
    for (int i = 0; i < 4; i++)
        t->is_raw = t->is_raw || memcmp(head, raw[i], 4) == 0;
    t->is_big = mark == 43;
    t->s->big_endian = head[0] == 'M';
    t->has_all_in_chain = memcmp(head + 8, "CR\2", 3) == 0;
    t->is_raw = t->is_raw || t->has_all_in_chain;
    return t->is_raw || mark == 42 || mark == 43;
}

static weft_code read_tiff(tiff *t, weft_container *container)
{
    uint64_t first;
    WEFT_TRY(fetch_number(t->s, t->is_big ? 8 : 4, t->is_big ? 8 : 4, &first));
    WEFT_TRY(read_directories(t, first));
    *container = t->is_raw ? WEFT_CONTAINER_RAW : WEFT_CONTAINER_TIFF;
    return WEFT_OK;
}

static weft_code read_raf(source *s)
{
    /* Places of offset and length: of the preview, and of the values of the sensor. */
    static const uint64_t section[] = {84, 100};
    uint64_t offset, count;
    s->big_endian = true;
    for (int i = 0; i < 2; i++) {
        WEFT_TRY(fetch_number(s, section[i], 4, &offset));
        WEFT_TRY(fetch_number(s, section[i] + 4, 4, &count));
        if (!holds(s, offset, count))
            return damaged(s, "it ends too early");
    }
    return WEFT_OK;
}

/* ---- OpenEXR ---- */

/* Names and types of attributes have at most 255 letters. */
static weft_code fetch_name(const source *s, uint64_t *place, char name[256])
{
    for (size_t i = 0; i < 256; i++) {
        WEFT_TRY(fetch(s, (*place)++, name + i, 1));
        if (!name[i])
            return WEFT_OK;
    }
    return damaged(s, "its header is none");
}

/* The attributes of one header, from *place to what follows it; *is_empty: there are none. */
static weft_code read_exr_header(const source *s, uint64_t *place, bool *is_empty)
{
    char name[256], type[256];
    for (*is_empty = true;; *is_empty = false) {
        uint64_t size;
        WEFT_TRY(fetch_name(s, place, name));
        if (!name[0])
            return WEFT_OK;
        WEFT_TRY(fetch_name(s, place, type));
        WEFT_TRY(fetch_number(s, *place, 4, &size));
        *place += 4;
        if (!holds(s, *place, size))
            return damaged(s, "its header ends too early");
        *place += size;
    }
}

/* The library takes a size for true before it reads what is there. */
static weft_code read_exr(source *s)
{
    enum { DEEP = 0x800, PARTS = 0x1000 };
    uint64_t flags, place = 8;
    bool is_empty;
    WEFT_TRY(fetch_number(s, 4, 4, &flags));
    if (flags & DEEP)
        return weft_fail(s->error, WEFT_NOT_SUPPORTED, "image '%s' is a deep OpenEXR image: flatten it", s->path);
    do
        WEFT_TRY(read_exr_header(s, &place, &is_empty));
    while ((flags & PARTS) && !is_empty);
    return WEFT_OK;
}

/* ---- HEIF ---- */

typedef struct box {
    uint64_t place, size; /* of its contents */
    char type[5];
} box;

/* The box at *place of those that end at `end`; *place becomes that of the next one. */
static weft_code next_box(const source *s, uint64_t *place, uint64_t end, box *b)
{
    uint8_t head[8];
    uint64_t size, head_bytes = 8;
    WEFT_TRY(fetch(s, *place, head, sizeof head));
    size = number_of(s, head, 4);
    memcpy(b->type, head + 4, 4);
    b->type[4] = 0;
    if (size == 1) {
        WEFT_TRY(fetch_number(s, *place + 8, 8, &size));
        head_bytes = 16;
    } else if (size == 0) {
        size = end - *place;
    }
    if (size < head_bytes || size > end - *place)
        return damaged(s, "it ends too early");
    b->place = *place + head_bytes;
    b->size = size - head_bytes;
    *place += size;
    return WEFT_OK;
}

/* The box of a type within another, whose first `skip` bytes are no boxes; size 0 where there is none. With `index`,
 * which counts from 1, the box of that place, of any type. */
static weft_code find_box(const source *s, const box *within, uint64_t skip, const char *type, uint64_t index,
                          box *found)
{
    uint64_t end = within->place + within->size;
    for (uint64_t place = within->place + skip, count = 1; place + 8 <= end; count++) {
        WEFT_TRY(next_box(s, &place, end, found));
        if (index ? count == index : strcmp(found->type, type) == 0)
            return WEFT_OK;
    }
    *found = (box){.place = end};
    return WEFT_OK;
}

/* ISO 23001-17 and 14496-12, 12.1.5. A profile counts before the numbers. */
static weft_code read_colour_box(const source *s, const box *colour, weft_colour_tags *tags)
{
    const uint64_t most_profile = 1 << 24;
    uint8_t head[11] = {0};
    WEFT_TRY(fetch(s, colour->place, head, colour->size < sizeof head ? (size_t)colour->size : sizeof head));
    if (memcmp(head, "nclx", 4) == 0 && colour->size >= sizeof head) {
        tags->has_cicp = true;
        for (int i = 0; i < 3; i++)
            tags->cicp[i] = head[5 + 2 * i];
        /* What the library hands over is RGB of full range. */
        tags->cicp[2] = 0;
        tags->cicp[3] = 1;
    }
    bool is_profile = memcmp(head, "prof", 4) == 0 || memcmp(head, "rICC", 4) == 0;
    if (!is_profile || tags->profile || colour->size <= 4 || colour->size > most_profile)
        return WEFT_OK;
    tags->profile_size = (size_t)colour->size - 4;
    if (!(tags->profile = malloc(tags->profile_size)))
        return weft_fail_memory(s->error, s->path, tags->profile_size);
    return fetch(s, colour->place + 4, tags->profile, tags->profile_size);
}

/* Quarters of a turn, counterclockwise (23008-12, 6.5.10), as Exif has them. */
static weft_code read_turn_box(const source *s, const box *turn, weft_colour_tags *tags)
{
    static const int orientation[] = {0, 8, 3, 6};
    uint64_t quarters;
    WEFT_TRY(fetch_number(s, turn->place, 1, &quarters));
    tags->turned_as = orientation[quarters & 3];
    return WEFT_OK;
}

/* Colours and turn among the properties of one item (14496-12, ItemPropertyAssociationBox). */
static weft_code read_properties(const source *s, const box *list, const box *link, uint64_t item,
                                 weft_colour_tags *tags)
{
    enum { MOST_PROPERTIES = 1000 };
    uint64_t head, entries, place = link->place + 8, id, count, index;
    WEFT_TRY(fetch_number(s, link->place, 4, &head));
    WEFT_TRY(fetch_number(s, link->place + 4, 4, &entries));
    size_t id_bytes = head >> 24 ? 4 : 2, index_bytes = head & 1 ? 2 : 1;
    for (uint64_t i = 0; i < entries; i++) {
        WEFT_TRY(fetch_number(s, place, id_bytes, &id));
        WEFT_TRY(fetch_number(s, place + id_bytes, 1, &count));
        place += id_bytes + 1;
        for (uint64_t k = 0; k < count; k++, place += index_bytes) {
            box property;
            WEFT_TRY(fetch_number(s, place, index_bytes, &index));
            index &= index_bytes == 2 ? 0x7fff : 0x7f; /* above is whether it is essential */
            if (id != item || index == 0 || index > MOST_PROPERTIES)
                continue;
            WEFT_TRY(find_box(s, list, 0, "", index, &property));
            if (strcmp(property.type, "colr") == 0)
                WEFT_TRY(read_colour_box(s, &property, tags));
            else if (strcmp(property.type, "irot") == 0)
                WEFT_TRY(read_turn_box(s, &property, tags));
        }
        if (id == item)
            break;
    }
    return WEFT_OK;
}

static weft_code read_heif_colours(const source *s, const box *meta, weft_colour_tags *tags)
{
    box primary, properties, list, link;
    uint64_t version, item;
    WEFT_TRY(find_box(s, meta, 4, "pitm", 0, &primary));
    WEFT_TRY(find_box(s, meta, 4, "iprp", 0, &properties));
    if (primary.size == 0 || properties.size == 0)
        return WEFT_OK;
    WEFT_TRY(fetch_number(s, primary.place, 1, &version));
    WEFT_TRY(fetch_number(s, primary.place + 4, version ? 4 : 2, &item));
    WEFT_TRY(find_box(s, &properties, 0, "ipco", 0, &list));
    WEFT_TRY(find_box(s, &properties, 0, "ipma", 0, &link));
    return list.size && link.size ? read_properties(s, &list, &link, item, tags) : WEFT_OK;
}

static weft_code read_heif(source *s, weft_container *container, weft_colour_tags *tags)
{
    s->big_endian = true;
    for (uint64_t place = 0; place < s->size;) {
        box b;
        WEFT_TRY(next_box(s, &place, s->size, &b));
        if (strcmp(b.type, "meta") == 0 && *container == WEFT_CONTAINER_HEIF)
            WEFT_TRY(read_heif_colours(s, &b, tags));
    }
    /* A profile says more than the numbers. */
    tags->has_cicp = tags->has_cicp && !tags->profile;
    return WEFT_OK;
}

/* ---- Any file ---- */

static weft_code read_structure(source *s, weft_container *container, weft_colour_tags *tags)
{
    uint8_t head[16] = {0};
    tiff t = {.s = s};
    WEFT_TRY(fetch(s, 0, head, s->size < sizeof head ? (size_t)s->size : sizeof head));
    if (memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0) {
        *container = WEFT_CONTAINER_PNG;
        return read_png(s, tags);
    }
    if (memcmp(head, "\xff\xd8\xff", 3) == 0)
        return read_jpeg(s);
    if (memcmp(head, "\x76\x2f\x31\x01", 4) == 0) {
        *container = WEFT_CONTAINER_EXR;
        return read_exr(s);
    }
    if (memcmp(head, "FUJIFILMCCD-RAW ", 16) == 0) {
        *container = WEFT_CONTAINER_RAW;
        return read_raf(s);
    }
    if (memcmp(head + 4, "ftyp", 4) == 0) {
        *container = memcmp(head + 8, "crx ", 4) == 0 ? WEFT_CONTAINER_RAW : WEFT_CONTAINER_HEIF;
        return read_heif(s, container, tags);
    }
    return is_tiff(head, &t) ? read_tiff(&t, container) : WEFT_OK;
}

weft_code weft_container_read(const char *path, weft_container *container, weft_colour_tags *tags, weft_error *error)
{
    source s = {.file = fopen(path, "rb"), .path = path, .error = error};
    *container = WEFT_CONTAINER_OTHER;
    if (!s.file)
        return weft_fail(error, weft_code_of_reading(errno), "cannot read image '%s': %s", path, strerror(errno));
    weft_code code = WEFT_OK;
    if (fseeko(s.file, 0, SEEK_END) != 0 || ftello(s.file) < 0)
        code = weft_fail(error, WEFT_BAD_INPUT, "cannot read image '%s': %s", path, strerror(errno));
    if (code == WEFT_OK) {
        s.size = (uint64_t)ftello(s.file);
        code = s.size > 0 ? read_structure(&s, container, tags) : damaged(&s, "it is empty");
    }
    fclose(s.file);
    return code;
}
