#include "player/gl/label.h"

#include "player/gl/shaders.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

enum { VERTICES = 6, LONGEST = 128, SMALLEST = 13, LARGEST = 96 };

typedef struct label_vertex {
    float x, y, z, u, v;
} label_vertex;

/* Pixels from the upper left corner of the viewport, or of the font. */
typedef struct rectangle {
    float left, top, right, bottom;
} rectangle;

const weft_label_ink weft_plain_ink = {{0.01f, 0.01f, 0.01f, 0.6f}, {0.85f, 0.85f, 0.85f, 1}};

weft_code weft_labels_create(weft_labels *labels, weft_error *error)
{
    const char *const vertex[] = {weft_glsl_text_vert, NULL}, *const fragment[] = {weft_glsl_text_frag, NULL};
    *labels = (weft_labels){0};
    WEFT_TRY(weft_gl_program("text", vertex, fragment, &labels->program, error));
    glGenVertexArrays(1, &labels->vertex_array);
    glGenBuffers(1, &labels->vertex_buffer);
    glBindVertexArray(labels->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, labels->vertex_buffer);
    glEnableVertexAttribArray(WEFT_ATTRIBUTE_POSITION);
    glEnableVertexAttribArray(WEFT_ATTRIBUTE_COORDINATE);
    glVertexAttribPointer(WEFT_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, sizeof(label_vertex), NULL);
    glVertexAttribPointer(WEFT_ATTRIBUTE_COORDINATE, 2, GL_FLOAT, GL_FALSE, sizeof(label_vertex),
                          (void *)offsetof(label_vertex, u));
    glBindVertexArray(0);
    return weft_gl_check("making labels", error);
}

void weft_labels_free(weft_labels *labels)
{
    glDeleteProgram(labels->program);
    glDeleteTextures(1, &labels->font);
    glDeleteVertexArrays(1, &labels->vertex_array);
    glDeleteBuffers(1, &labels->vertex_buffer);
    weft_letters_free(&labels->letters);
    *labels = (weft_labels){0};
}

int weft_label_size(int picture_height)
{
    int size = picture_height / 36;
    return size < SMALLEST ? SMALLEST : size > LARGEST ? LARGEST : size;
}

static weft_code set_size(weft_labels *labels, int size, weft_error *error)
{
    weft_letters_free(&labels->letters);
    glDeleteTextures(1, &labels->font);
    labels->font = 0;
    WEFT_TRY(weft_letters_bake(size, &labels->letters, error));
    return weft_gl_texture((weft_texture_format){GL_R8, GL_RED, GL_UNSIGNED_BYTE}, labels->letters.side,
                           labels->letters.side, 0, labels->letters.coverage, &labels->font, error);
}

static void set_quad(label_vertex *vertex, rectangle place, rectangle source)
{
    static const int corner[VERTICES] = {0, 1, 3, 0, 3, 2};
    for (int i = 0; i < VERTICES; i++) {
        bool right = corner[i] % 2, lower = corner[i] / 2;
        vertex[i] = (label_vertex){right ? place.right : place.left, lower ? place.bottom : place.top, 0,
                                   right ? source.right : source.left, lower ? source.bottom : source.top};
    }
}

static int set_letters(const weft_letters *letters, label_vertex *vertex, const char *text, float x, float baseline)
{
    int count = 0;
    for (; *text; text++, count += VERTICES) {
        const stbtt_bakedchar *g = weft_letters_find(letters, *text);
        float left = x + roundf(g->xoff), top = baseline + roundf(g->yoff);
        rectangle source = {g->x0, g->y0, g->x1, g->y1};
        rectangle place = {left, top, left + source.right - source.left, top + source.bottom - source.top};
        set_quad(vertex + count, place, source);
        x += (float)weft_letters_advance(letters, *text);
    }
    return count;
}

static void draw(const weft_labels *labels, int width, int height, const label_vertex *vertex, int count,
                 const weft_label_ink *colours)
{
    GLint ink = weft_gl_uniform(labels->program, "ink");
    glBindVertexArray(labels->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, labels->vertex_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((size_t)count * sizeof *vertex), vertex, GL_STREAM_DRAW);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glUseProgram(labels->program);
    weft_gl_set_vec2(labels->program, "viewport", width, height);
    weft_gl_bind(labels->program, "font", 0, GL_TEXTURE_2D, labels->font);
    glUniform4fv(ink, 1, colours->plate);
    glDrawArrays(GL_TRIANGLES, 0, VERTICES);
    glUniform4fv(ink, 1, colours->letters);
    glDrawArrays(GL_TRIANGLES, VERTICES, count - VERTICES);
    glDisable(GL_BLEND);
}

weft_code weft_label_draw(weft_labels *labels, int width, int height, int x, int y, bool to_the_left, const char *text,
                          const weft_label_ink *ink, weft_error *error)
{
    label_vertex vertex[VERTICES * (1 + LONGEST)];
    char line[LONGEST + 1];
    int size = weft_label_size(height);
    if (labels->letters.size != size)
        WEFT_TRY(set_size(labels, size, error));
    snprintf(line, sizeof line, "%s", text);
    float margin = roundf(0.45f * (float)size),
          plate_width = (float)weft_letters_length(&labels->letters, line) + 2 * margin;
    float left = to_the_left ? (float)x - plate_width : (float)x, top = (float)y;
    set_quad(vertex, (rectangle){left, top, left + plate_width, top + roundf(1.5f * (float)size)}, (rectangle){0});
    int count =
        set_letters(&labels->letters, vertex + VERTICES, line, left + margin, top + roundf(1.08f * (float)size));
    draw(labels, width, height, vertex, VERTICES + count, ink);
    return WEFT_OK;
}
