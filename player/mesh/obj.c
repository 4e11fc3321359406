/* Wavefront OBJ. Written here rather than taken from tinyobjloader: Debian's is a release candidate of a C++ library
 * that hands out indices without checking them against the arrays, and four statements are all that is needed. */
#include "player/mesh/mesh.h"

#include "base/atomic_file.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { POSITION, COORDINATE, NORMAL, STATEMENTS };
static const char *const keyword[STATEMENTS] = {"v", "vt", "vn"};
static const int components[STATEMENTS] = {3, 2, 3};
static const size_t largest_file = (size_t)1 << 32;

typedef struct reader {
    const char *path;
    int line;
    float *value[STATEMENTS]; /* [count][3] */
    int count[STATEMENTS];    /* so far */
    int total[STATEMENTS];    /* in the file */
    int corner_count, triangle_count;
    int (*corner)[3]; /* position, coordinate, normal (-1 = none) of each distinct corner */
    uint32_t *slot;   /* hash table: corner + 1, 0 = free */
    size_t slot_count;
    weft_mesh *mesh;
    weft_error *error;
} reader;

static weft_code fail(reader *r, const char *what)
{
    return weft_fail(r->error, WEFT_BAD_INPUT, "%s:%d: %s", r->path, r->line, what);
}

/* ---- Words and lines ---- */

static const char *skip_blanks(const char *at)
{
    while (*at == ' ' || *at == '\t')
        at++;
    return at;
}

static bool at_end(const char *at)
{
    return *at == '\0' || *at == '\n' || *at == '\r' || *at == '#';
}

/* Behind `word` where the line starts with it and a blank, else NULL. */
static const char *after_keyword(const char *line, const char *word)
{
    size_t length = strlen(word);
    line = skip_blanks(line);
    return strncmp(line, word, length) == 0 && (line[length] == ' ' || line[length] == '\t') ? line + length : NULL;
}

static bool is_separator(char c)
{
    return c == '\0' || c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static const char *skip_word(const char *at)
{
    while (!is_separator(*at))
        at++;
    return at;
}

static int count_words(const char *at)
{
    int words = 0;
    for (at = skip_blanks(at); !at_end(at); at = skip_blanks(skip_word(at)))
        words++;
    return words;
}

typedef weft_code statement_handler(reader *r, const char *line);

static weft_code for_each_line(reader *r, const char *text, statement_handler *handle)
{
    r->line = 1;
    for (const char *line = text; line; r->line++) {
        WEFT_TRY(handle(r, line));
        line = strchr(line, '\n');
        line = line ? line + 1 : NULL;
    }
    return WEFT_OK;
}

/* ---- First pass: how much there is ---- */

static weft_code count_statement(reader *r, const char *line)
{
    for (int kind = 0; kind < STATEMENTS; kind++) {
        if (after_keyword(line, keyword[kind]) && ++r->total[kind] > WEFT_MESH_MAX_VERTICES)
            return fail(r, "more vertices than a mesh may have (67108864)");
    }
    const char *face = after_keyword(line, "f");
    if (!face)
        return WEFT_OK;
    int corners = count_words(face);
    if (corners < 3)
        return fail(r, "a face needs at least three corners");
    if (corners > WEFT_MESH_MAX_TRIANGLES - r->triangle_count)
        return fail(r, "more triangles than a mesh may have (67108864)");
    r->triangle_count += corners - 2;
    return WEFT_OK;
}

static weft_code allocate(reader *r)
{
    size_t largest_corner_count = (size_t)r->triangle_count * 3;
    for (r->slot_count = 64; r->slot_count < 2 * largest_corner_count; r->slot_count *= 2)
        continue;
    for (int kind = 0; kind < STATEMENTS; kind++) {
        r->value[kind] = calloc((size_t)r->total[kind] + 1, 3 * sizeof(float));
        if (!r->value[kind])
            return weft_fail_memory(r->error, "OBJ vertices", (size_t)r->total[kind] * 12);
    }
    r->corner = calloc(largest_corner_count, sizeof *r->corner);
    r->slot = calloc(r->slot_count, sizeof *r->slot);
    r->mesh->index = calloc((size_t)r->triangle_count, sizeof *r->mesh->index);
    if (!r->corner || !r->slot || !r->mesh->index)
        return weft_fail_memory(r->error, "OBJ faces", r->slot_count * sizeof *r->slot);
    return WEFT_OK;
}

/* ---- Second pass: values and faces ---- */

static weft_code read_values(reader *r, int kind, const char *at)
{
    float *value = r->value[kind] + 3 * (size_t)r->count[kind]++;
    for (int i = 0; i < components[kind]; i++) {
        at = skip_blanks(at);
        char *end = (char *)at;
        double number = at_end(at) ? 0 : strtod(at, &end);
        /* One texture coordinate is allowed; the second is then 0. */
        if (end == at && kind == COORDINATE && i == 1 && at_end(at))
            return WEFT_OK;
        if (end == at)
            return fail(r, "a number is missing");
        if (!isfinite((float)number))
            return fail(r, "a number is not finite or too large");
        value[i] = (float)number;
        at = end;
    }
    return WEFT_OK;
}

/* One index of a corner: 1-based, or counted back from the last when negative. */
static weft_code read_index(reader *r, int kind, const char **at, int *index)
{
    char *end;
    errno = 0;
    long number = strtol(*at, &end, 10);
    if (end == *at)
        return fail(r, "a face corner is not of the form position/coordinate/normal");
    *at = end;
    long count = r->count[kind];
    if (errno || number == 0 || number > count || number < -count)
        return weft_fail(r->error, WEFT_BAD_INPUT, "%s:%d: a face refers to %s %ld, there are %ld up to here", r->path,
                         r->line, keyword[kind], number, count);
    *index = (int)(number > 0 ? number - 1 : count + number);
    return WEFT_OK;
}

static weft_code read_corner(reader *r, const char **at, int corner[3])
{
    corner[COORDINATE] = corner[NORMAL] = -1;
    WEFT_TRY(read_index(r, POSITION, at, &corner[POSITION]));
    for (int kind = COORDINATE; kind < STATEMENTS && **at == '/'; kind++) {
        ++*at;
        if (**at != '/' && !is_separator(**at))
            WEFT_TRY(read_index(r, kind, at, &corner[kind]));
    }
    if (!is_separator(**at))
        return fail(r, "a face corner is not of the form position/coordinate/normal");
    if (corner[COORDINATE] < 0)
        return fail(r, "a face has no texture coordinates, and a material needs them");
    return WEFT_OK;
}

static size_t hash_corner(const int corner[3])
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++)
        hash = (hash ^ (uint32_t)corner[i]) * 0x9e3779b97f4a7c15u;
    return (size_t)(hash ^ hash >> 29);
}

/* Index of the vertex with these three parts, made when it is new. */
static uint32_t find_vertex(reader *r, const int corner[3])
{
    size_t at = hash_corner(corner) & (r->slot_count - 1);
    while (r->slot[at] && memcmp(r->corner[r->slot[at] - 1], corner, sizeof r->corner[0]) != 0)
        at = (at + 1) & (r->slot_count - 1);
    if (!r->slot[at]) {
        memcpy(r->corner[r->corner_count], corner, sizeof r->corner[0]);
        r->slot[at] = (uint32_t)++r->corner_count;
    }
    return r->slot[at] - 1;
}

static weft_code read_face(reader *r, const char *at)
{
    uint32_t fan[3] = {0};
    int corners = 0;
    for (at = skip_blanks(at); !at_end(at); at = skip_blanks(at), corners++) {
        int corner[3];
        WEFT_TRY(read_corner(r, &at, corner));
        fan[1] = fan[2];
        fan[2] = find_vertex(r, corner);
        if (corners == 0)
            fan[0] = fan[2];
        if (corners >= 2)
            memcpy(r->mesh->index[r->triangle_count++], fan, sizeof fan);
    }
    return WEFT_OK;
}

static weft_code read_statement(reader *r, const char *line)
{
    for (int kind = 0; kind < STATEMENTS; kind++) {
        const char *values = after_keyword(line, keyword[kind]);
        if (values)
            return read_values(r, kind, values);
    }
    const char *face = after_keyword(line, "f");
    return face ? read_face(r, face) : WEFT_OK;
}

/* ---- The mesh ---- */

static void set_vertex(const reader *r, const int corner[3], weft_vertex *vertex)
{
    const float *p = r->value[POSITION] + 3 * (size_t)corner[POSITION];
    memcpy(vertex->position, (float[3]){p[0], -p[2], p[1]}, sizeof vertex->position);
    memcpy(vertex->coordinate, r->value[COORDINATE] + 3 * (size_t)corner[COORDINATE], sizeof vertex->coordinate);
    if (corner[NORMAL] < 0)
        return;
    const float *n = r->value[NORMAL] + 3 * (size_t)corner[NORMAL];
    float length = hypotf(hypotf(n[0], n[1]), n[2]);
    if (length > 0 && isfinite(length))
        memcpy(vertex->normal, (float[3]){n[0] / length, -n[2] / length, n[1] / length}, sizeof vertex->normal);
}

/* Faces meet smoothly at a position even where their texture coordinates differ: normals are summed over the first
 * vertex made at that position. */
static weft_code complete_normals(reader *r)
{
    weft_mesh *mesh = r->mesh;
    uint32_t *group = calloc((size_t)mesh->vertex_count, sizeof *group);
    uint32_t *first = calloc((size_t)r->total[POSITION] + 1, sizeof *first);
    weft_vertex *given = calloc((size_t)mesh->vertex_count, sizeof *given);
    weft_code code = WEFT_OK;
    if (!group || !first || !given) {
        code = weft_fail_memory(r->error, "OBJ normals", (size_t)mesh->vertex_count * sizeof *given);
    } else {
        for (int i = 0; i < mesh->vertex_count; i++) {
            uint32_t *at = &first[r->corner[i][POSITION]];
            if (*at == 0)
                *at = (uint32_t)i + 1;
            group[i] = *at - 1;
        }
        memcpy(given, mesh->vertex, (size_t)mesh->vertex_count * sizeof *given);
        code = weft_mesh_compute_normals(mesh, group, r->error);
        for (int i = 0; code == WEFT_OK && i < mesh->vertex_count; i++) {
            const float *n = given[i].normal;
            if (n[0] != 0 || n[1] != 0 || n[2] != 0)
                memcpy(mesh->vertex[i].normal, n, sizeof given[i].normal);
        }
    }
    free(group);
    free(first);
    free(given);
    return code;
}

static weft_code build_mesh(reader *r)
{
    weft_mesh *mesh = r->mesh;
    mesh->vertex_count = r->corner_count;
    mesh->triangle_count = r->triangle_count;
    mesh->vertex = calloc((size_t)r->corner_count, sizeof *mesh->vertex);
    if (!mesh->vertex)
        return weft_fail_memory(r->error, "OBJ mesh", (size_t)r->corner_count * sizeof *mesh->vertex);
    for (int i = 0; i < r->corner_count; i++)
        set_vertex(r, r->corner[i], &mesh->vertex[i]);
    weft_mesh_measure(mesh);
    WEFT_TRY(complete_normals(r));
    return weft_mesh_compute_tangents(mesh, r->error);
}

static weft_code parse(reader *r, const char *text, size_t size)
{
    if (strlen(text) != size)
        return weft_fail(r->error, WEFT_BAD_INPUT, "'%s' is not an OBJ file: it holds a zero byte", r->path);
    WEFT_TRY(for_each_line(r, text, count_statement));
    if (r->triangle_count == 0)
        return weft_fail(r->error, WEFT_BAD_INPUT, "'%s' is not an OBJ file with faces", r->path);
    WEFT_TRY(allocate(r));
    r->triangle_count = 0;
    WEFT_TRY(for_each_line(r, text, read_statement));
    return build_mesh(r);
}

weft_code weft_mesh_read_obj(const char *path, weft_mesh *mesh, weft_error *error)
{
    *mesh = (weft_mesh){0};
    char *text = NULL;
    size_t size = 0;
    WEFT_TRY(weft_read_file(path, largest_file, &text, &size, error));
    reader r = {.path = path, .mesh = mesh, .error = error};
    weft_code code = parse(&r, text, size);
    for (int kind = 0; kind < STATEMENTS; kind++)
        free(r.value[kind]);
    free(r.corner);
    free(r.slot);
    free(text);
    if (code != WEFT_OK)
        weft_mesh_free(mesh);
    return code;
}
