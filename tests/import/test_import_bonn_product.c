/* The inner loops of the images of Bonn for every instruction set, against plain sums in double. */
#include "base/processor.h"
#include "import/bonn/product.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { MOST_ROWS = 8, MOST_COMPONENTS = 100 };

static const weft_bonn_kernels *kernels_of(weft_instruction_set set)
{
#if defined(__x86_64__)
    static const weft_bonn_kernels *const all[WEFT_INSTRUCTION_SETS] = {
        &weft_bonn_kernels_baseline, &weft_bonn_kernels_avx2, &weft_bonn_kernels_avx512};
    return all[set];
#else
    (void)set;
    return &weft_bonn_kernels_baseline;
#endif
}

static float number_at(int i)
{
    return (float)(i * 7919 % 257 - 100) / 64;
}

static void check_product(const weft_bonn_kernels *kernels, int rows, int components)
{
    static _Alignas(64) float texels[MOST_COMPONENTS * WEFT_BONN_BLOCK], values[MOST_ROWS * WEFT_BONN_BLOCK];
    float weights[MOST_ROWS][MOST_COMPONENTS];
    const float *row[MOST_ROWS] = {NULL};
    for (int i = 0; i < components * WEFT_BONN_BLOCK; i++)
        texels[i] = number_at(i);
    for (int i = 0; i < rows; i++) {
        row[i] = weights[i];
        for (int k = 0; k < components; k++)
            weights[i][k] = number_at(3 * i + 11 * k + 5);
    }
    kernels->multiply(row, rows, texels, components, values);
    for (int i = 0; i < rows * WEFT_BONN_BLOCK; i++) {
        double sum = 0;
        for (int k = 0; k < components; k++)
            sum += (double)row[i / WEFT_BONN_BLOCK][k] * (double)texels[k * WEFT_BONN_BLOCK + i % WEFT_BONN_BLOCK];
        assert_float_equal(values[i], sum, 1e-3);
    }
}

static void products_are_sums_of_products(void **state)
{
    (void)state;
    for (int set = WEFT_BASELINE; set <= (int)weft_processor_best(); set++)
        for (int rows = 1; rows <= MOST_ROWS; rows++)
            for (int components = 1; components <= MOST_COMPONENTS; components += 33)
                check_product(kernels_of((weft_instruction_set)set), rows, components);
}

static void halves_are_widened(void **state)
{
    (void)state;
    static weft_half half[1 << 16];
    static float single[1 << 16];
    for (int i = 0; i < 1 << 16; i++)
        half[i] = (weft_half)i;
    for (int set = WEFT_BASELINE; set <= (int)weft_processor_best(); set++) {
        kernels_of((weft_instruction_set)set)->widen(half, 1 << 16, single);
        for (int i = 0; i < 1 << 16; i++)
            assert_true((i & 0x7c00) == 0x7c00 || single[i] == weft_float_of_half(half[i]));
    }
}

int test_import_bonn_product(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_are_sums_of_products),
        cmocka_unit_test(halves_are_widened),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
