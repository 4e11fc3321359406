/* Blocks that the encoder makes, as the specification decodes them, and as the graphics driver does. */
#include "../../support/keep_modules.h"
#include "../stage.h"
#include "base/processor.h"
#include "bc6h_decode.h"
#include "player/gl/gl.h"
#include "player/raw/bc6h.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 16, BLOCKS = 37 };

/* value[t][c][k], as the encoder takes it. */
typedef float block_values[TEXELS][3][BLOCKS];

static void encode(block_values value, uint8_t block[BLOCKS][16])
{
    const float *texel[TEXELS][3];
    for (int t = 0; t < TEXELS; t++) {
        for (int c = 0; c < 3; c++)
            texel[t][c] = value[t][c];
    }
    weft_bc6h_encode((const float *const(*)[3])texel, BLOCKS, block[0], 16);
}

/* One block, in the last place of a batch that is not full. */
static int encode_one(float value[TEXELS][3], weft_half decoded[TEXELS][3])
{
    uint8_t block[16];
    const float *texel[TEXELS][3];
    for (int t = 0; t < TEXELS; t++) {
        for (int c = 0; c < 3; c++)
            texel[t][c] = &value[t][c];
    }
    weft_bc6h_encode((const float *const(*)[3])texel, 1, block, 16);
    return bc6h_decode(block, decoded);
}

static int encode_constant(const float colour[3], weft_half decoded[TEXELS][3])
{
    float value[TEXELS][3];
    for (int t = 0; t < TEXELS; t++)
        memcpy(value[t], colour, sizeof value[t]);
    return encode_one(value, decoded);
}

static void a_block_of_one_colour_comes_out_exact(void **state)
{
    (void)state;
    for (int half = 0; half <= 0x7bff; half += 7) {
        const weft_half expected[3] = {(weft_half)half, (weft_half)(0x7bff - half), (weft_half)(half / 3)};
        float colour[3];
        weft_half decoded[TEXELS][3];
        for (int c = 0; c < 3; c++)
            colour[c] = weft_float_of_half(expected[c]);
        assert_int_equal(encode_constant(colour, decoded), 14);
        for (int t = 0; t < TEXELS; t++)
            assert_memory_equal(decoded[t], expected, sizeof expected);
    }
}

static void what_no_half_float_holds_becomes_the_nearest_that_does(void **state)
{
    (void)state;
    const float colours[][3] = {{-1, -0.0f, -1e30f}, {NAN, 0, NAN}, {1e30f, INFINITY, 65504}, {1e-30f, 1e-9f, 0}};
    static const weft_half expected[] = {0, 0, 0x7bff, 0};
    for (size_t i = 0; i < sizeof colours / sizeof *colours; i++) {
        weft_half decoded[TEXELS][3];
        assert_int_equal(encode_constant(colours[i], decoded), 14);
        for (int t = 0; t < TEXELS; t++) {
            for (int c = 0; c < 3; c++)
                assert_int_equal(decoded[t][c], expected[i]);
        }
    }
}

/* The largest relative error of one block. */
static double error_of(float value[TEXELS][3], int *mode)
{
    weft_half decoded[TEXELS][3];
    double largest = 0;
    *mode = encode_one(value, decoded);
    for (int t = 0; t < TEXELS; t++) {
        for (int c = 0; c < 3; c++) {
            double got = (double)weft_float_of_half(decoded[t][c]), wanted = (double)value[t][c];
            largest = fmax(largest, fabs(got - wanted) / wanted);
        }
    }
    return largest;
}

/* Half the distance of two places and half a step of the ends, in bit patterns of half floats: an octave is 1024, and
 * one of them at most 1/1024 of the value. */
static double expected_error(double ratio, int step)
{
    return (1.1 * 1024 * log2(ratio) / 15 + step) / 2 / 1024 + 1e-3;
}

static void every_mode_is_chosen_where_it_is_the_finest_that_reaches(void **state)
{
    (void)state;
    const struct {
        double ratio;
        int mode, step;
    } expected[] = {{1.001, 14, 1}, {1.5, 13, 8}, {8, 12, 16}, {100, 11, 31}, {3e4, 11, 31}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        float value[TEXELS][3];
        for (int t = 0; t < TEXELS; t++) {
            for (int c = 0; c < 3; c++)
                value[t][c] = (float)((1 << c) * 0.01 * pow(expected[i].ratio, (t * 7 % 16) / 15.0));
        }
        int mode;
        double error = error_of(value, &mode);
        assert_int_equal(mode, expected[i].mode);
        assert_true(error < expected_error(expected[i].ratio, expected[i].step));
    }
}

/* Two colours that share no line through black; green rises while red falls. */
static void opposite_colours_lie_on_one_line(void **state)
{
    (void)state;
    float value[TEXELS][3];
    int mode;
    for (int t = 0; t < TEXELS; t++) {
        value[t][0] = t % 3 ? 0.4f : 0.1f;
        value[t][1] = t % 3 ? 0.1f : 0.4f;
        value[t][2] = 0.2f;
    }
    assert_true(error_of(value, &mode) < 0.008);
}

static void a_dark_texel_does_not_spoil_bright_ones(void **state)
{
    (void)state;
    float value[TEXELS][3];
    weft_half decoded[TEXELS][3];
    for (int t = 0; t < TEXELS; t++) {
        for (int c = 0; c < 3; c++)
            value[t][c] = t == 5 ? 0 : 0.5f + 0.02f * (float)(t % 4);
    }
    encode_one(value, decoded);
    assert_true(weft_float_of_half(decoded[5][1]) < 1e-3f);
    for (int t = 0; t < TEXELS; t++)
        assert_float_equal(weft_float_of_half(decoded[t][0]), value[t][0], 0.05);
}

static void fill_with_noise(block_values value, uint64_t *random)
{
    for (int k = 0; k < BLOCKS; k++) {
        double brightest = exp2(30 * stage_uniform(random) - 15), range = 12 * stage_uniform(random);
        for (int t = 0; t < TEXELS; t++) {
            double level = brightest * exp2(-range * stage_uniform(random));
            for (int c = 0; c < 3; c++)
                value[t][c][k] = (float)(level * (0.9 + 0.2 * stage_uniform(random)));
        }
    }
}

/* Noise of colour is what one line cannot hold: 5.8 % of it, and steps of up to 12 octaves between 16 places. */
static void noise_stays_within_what_one_line_holds(void **state)
{
    (void)state;
    uint64_t random = 3;
    double square = 0, norm = 0;
    for (int round = 0; round < 100; round++) {
        block_values value;
        uint8_t block[BLOCKS][16];
        fill_with_noise(value, &random);
        encode(value, block);
        for (int k = 0; k < BLOCKS; k++) {
            weft_half decoded[TEXELS][3];
            assert_int_not_equal(bc6h_decode(block[k], decoded), 0);
            double brightest = 0, error = 0;
            for (int i = 0; i < TEXELS * 3; i++) {
                double wanted = (double)value[i / 3][i % 3][k];
                error += pow((double)weft_float_of_half(decoded[i / 3][i % 3]) - wanted, 2);
                brightest += wanted * wanted;
            }
            square += error / brightest;
            norm++;
        }
    }
    double relative = sqrt(square / norm);
    printf("noise: relative RMSE %.4f\n", relative);
    assert_true(relative < 0.08);
}

static void a_block_does_not_depend_on_its_neighbours(void **state)
{
    (void)state;
    uint64_t random = 9;
    block_values value;
    uint8_t block[BLOCKS][16];
    fill_with_noise(value, &random);
    encode(value, block);
    for (int k = 0; k < BLOCKS; k++) {
        float alone[TEXELS][3];
        weft_half together[TEXELS][3], single[TEXELS][3];
        for (int t = 0; t < TEXELS; t++) {
            for (int c = 0; c < 3; c++)
                alone[t][c] = value[t][c][k];
        }
        bc6h_decode(block[k], together);
        encode_one(alone, single);
        assert_memory_equal(together, single, sizeof single);
    }
}

static void every_instruction_set_finds_blocks_as_good(void **state)
{
    (void)state;
    for (int set = 0; set <= (int)weft_processor_best(); set++) {
        weft_processor_limit((weft_instruction_set)set);
        a_block_of_one_colour_comes_out_exact(state);
        every_mode_is_chosen_where_it_is_the_finest_that_reaches(state);
        noise_stays_within_what_one_line_holds(state);
    }
    weft_processor_limit(WEFT_INSTRUCTION_SETS);
}

/* ---- The driver's decoder ---- */

static const char *const vertex_parts[] = {
    "in vec2 position;\nvoid main() { gl_Position = vec4(position, 0.0, 1.0); }\n", NULL};
static const char *const fragment_parts[] = {
    "uniform sampler2DArray blocks;\nout vec4 colour;\n"
    "void main() { colour = texelFetch(blocks, ivec3(ivec2(gl_FragCoord.xy), 0), 0); }\n",
    NULL};

static GLuint upload(uint8_t block[BLOCKS][16])
{
    GLuint texture;
    weft_error error = {0};
    const weft_texture_format format = {GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT, 0, 0};
    expect_ok(weft_gl_texture(format, 4 * BLOCKS, 4, 1, NULL, &texture, &error), &error);
    glCompressedTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, 4 * BLOCKS, 4, 1, format.internal, BLOCKS * 16, block);
    expect_ok(weft_gl_check("uploading blocks", &error), &error);
    return texture;
}

static void draw_texels(GLuint texture)
{
    static const float corner[] = {-1, -1, 3, -1, -1, 3};
    GLuint program, array, buffer;
    weft_error error = {0};
    expect_ok(weft_gl_program("texels", vertex_parts, fragment_parts, &program, &error), &error);
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof corner, corner, GL_STATIC_DRAW);
    glVertexAttribPointer(WEFT_ATTRIBUTE_POSITION, 2, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(WEFT_ATTRIBUTE_POSITION);
    glUseProgram(program);
    weft_gl_bind(program, "blocks", 0, GL_TEXTURE_2D_ARRAY, texture);
    glViewport(0, 0, 4 * BLOCKS, 4);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDeleteBuffers(1, &buffer);
    glDeleteVertexArrays(1, &array);
    glDeleteProgram(program);
}

static void read_texels(GLuint texture, float pixel[4][4 * BLOCKS][4])
{
    GLuint target, framebuffer;
    weft_error error = {0};
    const weft_texture_format format = {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    expect_ok(weft_gl_texture(format, 4 * BLOCKS, 4, 0, NULL, &target, &error), &error);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    draw_texels(texture);
    glReadPixels(0, 0, 4 * BLOCKS, 4, GL_RGBA, GL_FLOAT, pixel);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &target);
    expect_ok(weft_gl_check("reading texels", &error), &error);
}

/* Black, the largest half float, subnormal ones and one colour each, then noise. */
static void fill_with_extremes(block_values value)
{
    static const float single[] = {0, 65504, 1e-7f, 6e-5f, 0.5f};
    uint64_t random = 5;
    fill_with_noise(value, &random);
    for (int k = 0; k < 5; k++) {
        for (int i = 0; i < TEXELS * 3; i++)
            value[i / 3][i % 3][k] = single[k];
    }
    for (int i = 0; i < TEXELS * 3; i++)
        value[i / 3][i % 3][5] = i % 5 ? 65504 : 1e-7f;
}

static void expect_driver_to_decode(void)
{
    block_values value;
    uint8_t block[BLOCKS][16];
    static float pixel[4][4 * BLOCKS][4];
    fill_with_extremes(value);
    encode(value, block);
    GLuint texture = upload(block);
    read_texels(texture, pixel);
    glDeleteTextures(1, &texture);
    for (int k = 0; k < BLOCKS; k++) {
        weft_half decoded[TEXELS][3];
        bc6h_decode(block[k], decoded);
        for (int t = 0; t < TEXELS; t++) {
            const float *got = pixel[t / 4][4 * k + t % 4];
            for (int c = 0; c < 3; c++)
                assert_float_equal(got[c], weft_float_of_half(decoded[t][c]), 0);
            assert_float_equal(got[3], 1, 0);
        }
    }
}

static void decode_with(weft_gl_profile profile)
{
    weft_error error = {0};
    weft_headless *headless;
    bool can = weft_headless_create(profile, &headless, &error) == WEFT_OK;
    keep_modules_loaded();
    can = can && weft_gl_has_bc6h();
    if (can)
        expect_driver_to_decode();
    weft_headless_free(headless);
    if (!can)
        skip();
}

static void the_driver_decodes_bit_for_bit(void **state)
{
    (void)state;
    decode_with(WEFT_GL_CORE);
}

static void the_driver_decodes_bit_for_bit_in_opengl_es(void **state)
{
    (void)state;
    decode_with(WEFT_GL_ES);
}

int test_bc6h(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_of_one_colour_comes_out_exact),
        cmocka_unit_test(what_no_half_float_holds_becomes_the_nearest_that_does),
        cmocka_unit_test(every_mode_is_chosen_where_it_is_the_finest_that_reaches),
        cmocka_unit_test(opposite_colours_lie_on_one_line),
        cmocka_unit_test(a_dark_texel_does_not_spoil_bright_ones),
        cmocka_unit_test(noise_stays_within_what_one_line_holds),
        cmocka_unit_test(a_block_does_not_depend_on_its_neighbours),
        cmocka_unit_test(every_instruction_set_finds_blocks_as_good),
        cmocka_unit_test(the_driver_decodes_bit_for_bit),
        cmocka_unit_test(the_driver_decodes_bit_for_bit_in_opengl_es),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
