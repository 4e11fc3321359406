#include "player/overlay.h"

#include "player/font.h"
#include "player/shaders.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { GLYPH_VERTICES = 6, PLATE = WEFT_FONT_COUNT, GLYPHS = WEFT_FONT_COUNT + 1, MARGIN = 3 };

typedef struct glyph_vertex {
    float x, y, z, u, v;
} glyph_vertex;

/* All glyphs in a row, then a full cell for plates. */
static weft_code upload_font(GLuint *texture, weft_error *error)
{
    static uint8_t pixels[WEFT_FONT_CELL_HEIGHT][GLYPHS * WEFT_FONT_CELL_WIDTH];
    for (int g = 0; g < WEFT_FONT_COUNT; g++) {
        for (int i = 0; i < WEFT_FONT_ROWS * WEFT_FONT_COLUMNS; i++) {
            int row = i / WEFT_FONT_COLUMNS, column = i % WEFT_FONT_COLUMNS;
            bool ink = weft_font[g][row] >> (WEFT_FONT_COLUMNS - 1 - column) & 1;
            pixels[row + 1][g * WEFT_FONT_CELL_WIDTH + column] = ink ? 255 : 0;
        }
    }
    for (int row = 0; row < WEFT_FONT_CELL_HEIGHT; row++)
        memset(&pixels[row][PLATE * WEFT_FONT_CELL_WIDTH], 255, WEFT_FONT_CELL_WIDTH);
    return weft_gl_texture((weft_texture_format){GL_R8, GL_RED, GL_UNSIGNED_BYTE}, GLYPHS * WEFT_FONT_CELL_WIDTH,
                           WEFT_FONT_CELL_HEIGHT, 0, pixels, texture, error);
}

weft_code weft_overlay_create(weft_overlay *overlay, weft_error *error)
{
    const char *const vertex[] = {weft_glsl_text_vert, NULL}, *const fragment[] = {weft_glsl_text_frag, NULL};
    *overlay = (weft_overlay){0};
    WEFT_TRY(weft_gl_program("text", vertex, fragment, &overlay->program, error));
    WEFT_TRY(upload_font(&overlay->font, error));
    glGenVertexArrays(1, &overlay->vertex_array);
    glGenBuffers(1, &overlay->vertex_buffer);
    glBindVertexArray(overlay->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, overlay->vertex_buffer);
    glEnableVertexAttribArray(WEFT_ATTRIBUTE_POSITION);
    glEnableVertexAttribArray(WEFT_ATTRIBUTE_COORDINATE);
    glVertexAttribPointer(WEFT_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, sizeof(glyph_vertex), NULL);
    glVertexAttribPointer(WEFT_ATTRIBUTE_COORDINATE, 2, GL_FLOAT, GL_FALSE, sizeof(glyph_vertex),
                          (void *)offsetof(glyph_vertex, u));
    return weft_gl_check("making labels", error);
}

void weft_overlay_free(weft_overlay *overlay)
{
    glDeleteProgram(overlay->program);
    glDeleteTextures(1, &overlay->font);
    glDeleteVertexArrays(1, &overlay->vertex_array);
    glDeleteBuffers(1, &overlay->vertex_buffer);
    *overlay = (weft_overlay){0};
}

int weft_overlay_line_height(int scale)
{
    return WEFT_FONT_CELL_HEIGHT * scale;
}

/* Two triangles showing cell `glyph` of the font. */
static void set_quad(glyph_vertex *vertex, int glyph, float x, float y, float width, float height)
{
    static const int corner[GLYPH_VERTICES] = {0, 1, 3, 0, 3, 2};
    for (int i = 0; i < GLYPH_VERTICES; i++) {
        int right = corner[i] % 2, lower = corner[i] / 2;
        vertex[i] =
            (glyph_vertex){x + (float)right * width, y + (float)lower * height, 0,
                           (float)((glyph + right) * WEFT_FONT_CELL_WIDTH), (float)(lower * WEFT_FONT_CELL_HEIGHT)};
    }
}

static void measure(const char *text, int *columns, int *lines)
{
    *columns = 0;
    *lines = 1;
    for (int column = 0; *text; text++) {
        column = *text == '\n' ? 0 : column + 1;
        *lines += *text == '\n';
        *columns = column > *columns ? column : *columns;
    }
}

static int set_glyphs(glyph_vertex *vertex, const char *text, int x, int y, int scale)
{
    int count = 0, column = 0, line = 0;
    for (; *text; text++) {
        if (*text == '\n') {
            column = 0;
            line++;
            continue;
        }
        int glyph = *text >= WEFT_FONT_FIRST && *text < WEFT_FONT_FIRST + WEFT_FONT_COUNT ? *text : '?';
        set_quad(vertex + count, glyph - WEFT_FONT_FIRST, (float)(x + column++ * WEFT_FONT_CELL_WIDTH * scale),
                 (float)(y + line * WEFT_FONT_CELL_HEIGHT * scale), (float)(WEFT_FONT_CELL_WIDTH * scale),
                 (float)(WEFT_FONT_CELL_HEIGHT * scale));
        count += GLYPH_VERTICES;
    }
    return count;
}

static void draw(const weft_overlay *overlay, int width, int height, int count)
{
    GLint ink = glGetUniformLocation(overlay->program, "ink");
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glUseProgram(overlay->program);
    weft_gl_set_vec2(overlay->program, "viewport", width, height);
    weft_gl_bind(overlay->program, "font", 0, GL_TEXTURE_2D, overlay->font);
    glUniform4f(ink, 0.01f, 0.01f, 0.01f, 0.55f);
    glDrawArrays(GL_TRIANGLES, 0, GLYPH_VERTICES);
    glUniform4f(ink, 0.85f, 0.85f, 0.85f, 1);
    glDrawArrays(GL_TRIANGLES, GLYPH_VERTICES, count - GLYPH_VERTICES);
    glDisable(GL_BLEND);
}

void weft_overlay_text(const weft_overlay *overlay, int width, int height, int x, int y, int scale, const char *text)
{
    glyph_vertex *vertex = malloc((strlen(text) + 1) * GLYPH_VERTICES * sizeof *vertex);
    if (!vertex)
        return; /* a label is not worth a failure */
    int columns, lines, margin = MARGIN * scale;
    measure(text, &columns, &lines);
    set_quad(vertex, PLATE, (float)x, (float)y, (float)(columns * WEFT_FONT_CELL_WIDTH * scale + 2 * margin),
             (float)(lines * WEFT_FONT_CELL_HEIGHT * scale + 2 * margin));
    int count = GLYPH_VERTICES + set_glyphs(vertex + GLYPH_VERTICES, text, x + margin, y + margin, scale);
    glBindVertexArray(overlay->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, overlay->vertex_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((size_t)count * sizeof *vertex), vertex, GL_STREAM_DRAW);
    draw(overlay, width, height, count);
    free(vertex);
}
