/* Three mantissas of 9 bits with one exponent (EXT_texture_shared_exponent), decoded as the extension says. */
#include "player/raw/format.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdint.h>

enum { SIDE = WEFT_RAW_BLOCK, TEXELS = SIDE * SIDE };

static void decode(uint32_t code, double rgb[3])
{
    double unit = ldexp(1, (int)(code >> 27) - 15 - 9);
    for (int c = 0; c < 3; c++)
        rgb[c] = unit * (code >> 9 * c & 511);
}

/* One block with these colours. */
static void store(float colour[TEXELS][3], uint32_t code[TEXELS])
{
    float rows[SIDE][SIDE * 3];
    weft_raw_rows block = {.width = SIDE, .channels = 3, .image_count = 1};
    for (int i = 0; i < TEXELS * 3; i++)
        rows[i / 3 / SIDE][i % (3 * SIDE)] = colour[i / 3][i % 3];
    for (int y = 0; y < SIDE; y++)
        block.row[y] = rows[y];
    weft_raw_store(WEFT_RAW_SHARED_EXPONENT, &block, 0, 1, 1, code);
}

/* Every channel within half a unit of the largest one, of which the mantissa has at least 8 bits. */
static void channels_come_back_within_half_a_unit(void **state)
{
    (void)state;
    for (int step = 0; step < 4000; step++) {
        float colour[TEXELS][3];
        uint32_t code[TEXELS];
        for (int i = 0; i < TEXELS; i++) {
            /* Nearly powers of 2, from both sides, among the others. */
            double largest = ldexp(i % 2 ? 1 + step / 4000.0 : 1 - step * 1e-6, i - 8);
            for (int c = 0; c < 3; c++)
                colour[i][c] = (float)(c == i % 3 ? largest : largest * (step * 7 % 100) / 100);
        }
        store(colour, code);
        for (int i = 0; i < TEXELS; i++) {
            double rgb[3], largest = (double)fmaxf(colour[i][0], fmaxf(colour[i][1], colour[i][2]));
            decode(code[i], rgb);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(rgb[c] - (double)colour[i][c]) <= 1.001 * largest / 512);
        }
    }
}

static void nothing_negative_or_too_large_is_kept(void **state)
{
    (void)state;
    float colour[TEXELS][3] = {{-1, 0, NAN}, {1e9f, 1, 0}};
    uint32_t code[TEXELS];
    double rgb[3];
    store(colour, code);
    assert_int_equal(code[0], 0);
    decode(code[1], rgb);
    assert_float_equal(rgb[0], 65408, 0);
}

int test_shared_exponent(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_come_back_within_half_a_unit),
        cmocka_unit_test(nothing_negative_or_too_large_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
