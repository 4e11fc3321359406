#include "import/bonn/file.h"

#include "btf/direction/direction.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_IMAGES = 1 << 24, MOST_SIDE = 65536, MOST_PIXELS = 1 << 28 };

/* ---- Signature ---- */

typedef enum signature_kind { FOR_EACH_CHANNEL, JOINT, JOINT_WITH_HEADER, NOT_READ } signature_kind;

static const struct signature {
    const char *text;
    signature_kind kind;
    const char *words;
} signatures[] = {
    {"!DFMF08FC", FOR_EACH_CHANNEL, "a BTF of Bonn, matrices of every channel (DFMF)"},
    {"!FMF06FC", JOINT, "a BTF of Bonn, one pair of matrices (FMF)"},
    {"!FMF12FCE", JOINT_WITH_HEADER, "a BTF of Bonn, one pair of matrices (FMF)"},
    {"!PVF06FC", NOT_READ, "matrices of every view (PVF)"},
    {"!BDIF06R2!", NOT_READ, "images that are not factored (BDI)"},
};

/* The one with which `head`, text of up to 10 characters, begins; NULL where none does. */
static const struct signature *signature_of(const char *head)
{
    for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++) {
        if (strncmp(head, signatures[i].text, strlen(signatures[i].text)) == 0)
            return &signatures[i];
    }
    return NULL;
}

/* What the file holds, and whether frames of the texels follow. */
static weft_code read_signature(weft_bonn_reader *reader, const struct signature **signature, bool *has_frames,
                                weft_error *error)
{
    char head[11] = "";
    uint64_t size = reader->left < sizeof head - 1 ? reader->left : sizeof head - 1;
    WEFT_TRY(weft_bonn_reader_take(reader, head, size, error));
    *signature = signature_of(head);
    if (!*signature)
        return weft_fail(error, WEFT_NOT_SUPPORTED,
                         "'%s' begins with '%s'; supported are !DFMF08FC, !FMF06FC and !FMF12FCE", reader->path, head);
    if ((*signature)->kind == NOT_READ)
        return weft_fail(error, WEFT_NOT_SUPPORTED, "'%s' holds %s; only DFMF and FMF are read", reader->path,
                         (*signature)->words);
    size_t length = strlen((*signature)->text);
    *has_frames = head[length] == 'R';
    length += *has_frames;
    reader->left += size - length;
    if (fseeko(reader->stream, (off_t)length, SEEK_SET) != 0)
        return weft_fail_errno(error, "read", reader->path);
    return WEFT_OK;
}

/* ---- What was measured, and how ---- */

static weft_code read_words(weft_bonn_reader *reader, char words[WEFT_BONN_WORDS + 1], weft_error *error)
{
    WEFT_TRY(weft_bonn_reader_take(reader, words, WEFT_BONN_WORDS, error));
    words[WEFT_BONN_WORDS] = 0;
    return WEFT_OK;
}

static bool is_number(const char *name)
{
    char *end;
    strtod(name, &end);
    return end > name && *end == 0;
}

/* Names of channels; those of a spectrum are wavelengths. */
static weft_code read_channel_names(weft_bonn_reader *reader, weft_error *error)
{
    uint32_t count, length;
    WEFT_TRY(weft_bonn_reader_whole(reader, &count, error));
    if (count != WEFT_BONN_CHANNELS)
        return weft_fail(error, WEFT_NOT_SUPPORTED, "'%s' has %u channels of colour: only red, green and blue are read",
                         reader->path, count);
    for (uint32_t i = 0; i < count; i++) {
        char name[32] = "";
        WEFT_TRY(weft_bonn_reader_whole(reader, &length, error));
        uint32_t kept = length < sizeof name - 1 ? length : (uint32_t)sizeof name - 1;
        WEFT_TRY(weft_bonn_reader_take(reader, name, kept, error));
        WEFT_TRY(weft_bonn_reader_skip(reader, length - kept, error));
        if (is_number(name))
            return weft_fail(error, WEFT_NOT_SUPPORTED,
                             "'%s' is multispectral (channel '%s'): only red, green and blue are read", reader->path,
                             name);
    }
    return WEFT_OK;
}

/* What versions above the first add. */
static weft_code read_additions(weft_bonn_reader *reader, uint32_t version, weft_bonn_file *file, weft_error *error)
{
    uint32_t number;
    if (version > 1) {
        WEFT_TRY(weft_bonn_reader_whole(reader, &number, error));
        file->has_cosine = number != 0;
    }
    if (version > 2) {
        WEFT_TRY(weft_bonn_reader_whole(reader, &number, error));
        WEFT_TRY(weft_bonn_reader_skip(reader, number, error));
    }
    return version > 3 ? read_channel_names(reader, error) : WEFT_OK;
}

static weft_code read_description(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    const uint32_t newest = 4;
    uint64_t begin = reader->left;
    uint32_t size, version;
    float pixels_per_mm;
    reader->section = "description";
    WEFT_TRY(weft_bonn_reader_whole(reader, &size, error));
    WEFT_TRY(weft_bonn_reader_whole(reader, &version, error));
    if (version < 1 || version > newest)
        return weft_fail(error, WEFT_NOT_SUPPORTED, "'%s' is of version %u: 1 to %u are read", reader->path, version,
                         newest);
    WEFT_TRY(read_words(reader, file->setup, error));
    WEFT_TRY(read_words(reader, file->sensor, error));
    WEFT_TRY(read_words(reader, file->lamp, error));
    WEFT_TRY(weft_bonn_reader_singles(reader, &pixels_per_mm, 1, error));
    WEFT_TRY(weft_bonn_reader_singles(reader, file->rgb_scale, 3, error));
    WEFT_TRY(read_additions(reader, version, file, error));
    file->pixels_per_mm = (double)pixels_per_mm;
    if (begin - reader->left != size)
        return weft_fail(error, WEFT_DAMAGED, "'%s': its description should have %u bytes; it has %llu", reader->path,
                         size, (unsigned long long)(begin - reader->left));
    return WEFT_OK;
}

/* ---- Views and lights ---- */

/* theta from the normal, phi from x toward y. */
static weft_code read_direction(weft_bonn_reader *reader, const char *what, uint32_t index, weft_vec3 *direction,
                                weft_error *error)
{
    const weft_real horizon_rad = WEFT_PI / 2 - 1e-6;
    float angle[2];
    WEFT_TRY(weft_bonn_reader_singles(reader, angle, 2, error));
    weft_angles angles = {(weft_real)angle[0], (weft_real)angle[1]};
    if (!(angles.theta_rad >= 0 && angles.theta_rad < horizon_rad) || !isfinite(angles.phi_rad))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': %s %u is at theta %g, phi %g degrees, not above the surface",
                         reader->path, what, index, weft_deg_of_rad(angles.theta_rad), weft_deg_of_rad(angles.phi_rad));
    *direction = weft_direction_of_angles(angles);
    return WEFT_OK;
}

/* The lights of the first view decide how many all have. */
static weft_code allocate_lights(weft_bonn_reader *reader, uint32_t count, weft_bonn_file *file, weft_error *error)
{
    uint64_t images = (uint64_t)file->view_count * count;
    if (count < 1 || images > MOST_IMAGES)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d views and %u lights, must be 1 to %d images", reader->path,
                         file->view_count, count, MOST_IMAGES);
    WEFT_TRY(weft_bonn_reader_expect(reader, images * 2 * sizeof(float), error));
    file->light_count = (int)count;
    file->light = malloc(images * sizeof *file->light);
    return file->light ? WEFT_OK : weft_fail_memory(error, "lights", images * sizeof *file->light);
}

static weft_code read_view(weft_bonn_reader *reader, int view, weft_bonn_file *file, weft_error *error)
{
    uint32_t count;
    WEFT_TRY(read_direction(reader, "view", (uint32_t)view, &file->view[view], error));
    WEFT_TRY(weft_bonn_reader_whole(reader, &count, error));
    if (view == 0)
        WEFT_TRY(allocate_lights(reader, count, file, error));
    if (count != (uint32_t)file->light_count)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': view %d has %u lights, the first has %d", reader->path, view,
                         count, file->light_count);
    weft_vec3 *light = file->light + (size_t)view * count;
    for (uint32_t i = 0; i < count; i++)
        WEFT_TRY(read_direction(reader, "light", i, &light[i], error));
    return WEFT_OK;
}

static weft_code read_directions(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    uint32_t count;
    reader->section = "list of directions";
    WEFT_TRY(weft_bonn_reader_whole(reader, &count, error));
    if (count < 1 || count > MOST_IMAGES)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %u views, must be 1 to %d", reader->path, count, MOST_IMAGES);
    WEFT_TRY(weft_bonn_reader_expect(reader, (uint64_t)count * 3 * sizeof(float), error));
    file->view_count = (int)count;
    file->view = malloc(count * sizeof *file->view);
    if (!file->view)
        return weft_fail_memory(error, "views", count * sizeof *file->view);
    for (int i = 0; i < file->view_count; i++)
        WEFT_TRY(read_view(reader, i, file, error));
    return WEFT_OK;
}

/* ---- Texels ---- */

static weft_code read_frames(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    const uint64_t bytes_each = sizeof *file->frame;
    uint64_t texels = (uint64_t)file->width * (uint64_t)file->height;
    uint32_t count;
    reader->section = "list of frames";
    WEFT_TRY(weft_bonn_reader_whole(reader, &count, error));
    if (count == 0)
        return WEFT_OK;
    if (count != texels) {
        WEFT_TRY(weft_lines_add(&file->notes, error, "left out: %u frames of %llu texels", count,
                                (unsigned long long)texels));
        return weft_bonn_reader_skip(reader, count * bytes_each, error);
    }
    WEFT_TRY(weft_bonn_reader_expect(reader, count * bytes_each, error));
    file->frame = malloc(count * bytes_each);
    if (!file->frame)
        return weft_fail_memory(error, "frames", count * bytes_each);
    for (uint32_t i = 0; i < count; i++)
        WEFT_TRY(weft_bonn_reader_singles(reader, file->frame[i], 9, error));
    return WEFT_OK;
}

static weft_code read_extent(weft_bonn_reader *reader, bool has_frames, weft_bonn_file *file, weft_error *error)
{
    uint32_t width, height;
    reader->section = "size";
    WEFT_TRY(weft_bonn_reader_whole(reader, &width, error));
    WEFT_TRY(weft_bonn_reader_whole(reader, &height, error));
    if (width < 1 || height < 1 || width > MOST_SIDE || height > MOST_SIDE || (uint64_t)width * height > MOST_PIXELS)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %u x %u texels, must be 1 to %d along a side and %d in all",
                         reader->path, width, height, MOST_SIDE, MOST_PIXELS);
    file->width = (int)width;
    file->height = (int)height;
    return has_frames ? read_frames(reader, file, error) : WEFT_OK;
}

/* ---- Matrices ---- */

static weft_code read_channels(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    uint32_t most_components, model;
    reader->section = "colour model";
    WEFT_TRY(weft_bonn_reader_whole(reader, &most_components, error));
    WEFT_TRY(weft_bonn_reader_whole(reader, &model, error));
    file->colour.model = (int)model;
    WEFT_TRY(weft_bonn_reader_singles(reader, file->colour.mean, 3, error));
    WEFT_TRY(weft_bonn_reader_singles(reader, &file->colour.axis[0][0], 9, error));
    WEFT_TRY(weft_bonn_colour_check(&file->colour, reader->path, error));
    for (int c = 0; c < WEFT_BONN_CHANNELS; c++)
        WEFT_TRY(weft_bonn_matrices_read_channel(&file->matrices, c, reader, error));
    return WEFT_OK;
}

/* A map of heights: of which unit nobody says. */
static weft_code skip_heights(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    uint32_t width, height;
    WEFT_TRY(weft_bonn_reader_whole(reader, &width, error));
    WEFT_TRY(weft_bonn_reader_whole(reader, &height, error));
    uint64_t count = (uint64_t)width * height;
    if (count == 0)
        return WEFT_OK;
    if (count > reader->left)
        return weft_bonn_reader_expect(reader, count, error);
    WEFT_TRY(weft_lines_add(&file->notes, error, "left out: a map of %u x %u heights", width, height));
    return weft_bonn_reader_skip(reader, count * sizeof(weft_half), error);
}

static weft_code read_header(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    uint8_t version;
    uint32_t logarithm = 0;
    WEFT_TRY(weft_bonn_reader_byte(reader, &version, error));
    if (version > 2)
        return weft_fail(error, WEFT_NOT_SUPPORTED, "'%s': its header is of version %u: 0 to 2 are read", reader->path,
                         version);
    if (version > 0)
        WEFT_TRY(weft_bonn_reader_whole(reader, &logarithm, error));
    if (logarithm)
        file->colour.model = WEFT_BONN_LOG_RGB;
    return version > 1 ? skip_heights(reader, file, error) : WEFT_OK;
}

static weft_code read_joint(weft_bonn_reader *reader, bool has_header, weft_bonn_file *file, weft_error *error)
{
    uint32_t most_components;
    reader->section = "header";
    if (has_header)
        WEFT_TRY(read_header(reader, file, error));
    WEFT_TRY(weft_bonn_reader_whole(reader, &most_components, error));
    return weft_bonn_matrices_read_joint(&file->matrices, reader, error);
}

/* ---- All ---- */

static weft_code read_all(weft_bonn_reader *reader, weft_bonn_file *file, weft_error *error)
{
    const struct signature *signature;
    bool has_frames;
    WEFT_TRY(read_signature(reader, &signature, &has_frames, error));
    file->kind = signature->words;
    WEFT_TRY(read_description(reader, file, error));
    WEFT_TRY(read_directions(reader, file, error));
    WEFT_TRY(read_extent(reader, has_frames, file, error));
    file->matrices.image_count = (size_t)file->view_count * (size_t)file->light_count;
    file->matrices.texel_count = (size_t)file->width * (size_t)file->height;
    if (signature->kind == FOR_EACH_CHANNEL)
        WEFT_TRY(read_channels(reader, file, error));
    else
        WEFT_TRY(read_joint(reader, signature->kind == JOINT_WITH_HEADER, file, error));
    if (reader->left > 0)
        return weft_lines_add(&file->notes, error, "left out: %llu bytes behind the last matrix",
                              (unsigned long long)reader->left);
    return WEFT_OK;
}

weft_code weft_bonn_file_open(const char *path, weft_bonn_file *file, weft_error *error)
{
    weft_bonn_reader reader;
    *file = (weft_bonn_file){0};
    WEFT_TRY(weft_bonn_reader_open(path, &reader, error));
    weft_code code = read_all(&reader, file, error);
    fclose(reader.stream);
    if (code != WEFT_OK)
        weft_bonn_file_close(file);
    return code;
}

void weft_bonn_file_close(weft_bonn_file *file)
{
    weft_bonn_matrices_free(&file->matrices);
    weft_lines_free(&file->notes);
    free(file->view);
    free(file->light);
    free(file->frame);
    *file = (weft_bonn_file){0};
}
