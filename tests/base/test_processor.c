/* The choice of an instruction set: a set is used only where the processor has all that its kernels are compiled with.
 */
#include "base/processor.h"
#include "tests/support/cmocka_all.h"

static void avx2_needs_fma_and_f16c(void **state)
{
    (void)state;
    const unsigned all = WEFT_HAS_AVX2 | WEFT_HAS_FMA | WEFT_HAS_F16C;
    for (unsigned flags = 0; flags <= all; flags++)
        assert_int_equal(weft_instruction_set_of(flags), flags == all ? WEFT_AVX2 : WEFT_BASELINE);
}

static void avx512_needs_what_avx2_needs(void **state)
{
    (void)state;
    const unsigned all = WEFT_HAS_AVX2 | WEFT_HAS_FMA | WEFT_HAS_F16C | WEFT_HAS_AVX512;
    assert_int_equal(weft_instruction_set_of(all), WEFT_AVX512);
    assert_int_equal(weft_instruction_set_of(all & ~(unsigned)WEFT_HAS_F16C), WEFT_BASELINE);
    assert_int_equal(weft_instruction_set_of(WEFT_HAS_AVX512), WEFT_BASELINE);
}

/* Stand for the kernels of one source. */
static int in_use_baseline(void)
{
    return WEFT_BASELINE;
}
#if defined(__x86_64__)
static int in_use_avx2(void)
{
    return WEFT_AVX2;
}
static int in_use_avx512(void)
{
    return WEFT_AVX512;
}
#endif

static void a_limit_holds_until_it_is_lifted(void **state)
{
    (void)state;
    weft_instruction_set before = weft_processor_instruction_set(), best = weft_processor_best();
    for (int most = 0; most < WEFT_INSTRUCTION_SETS; most++) {
        weft_processor_limit((weft_instruction_set)most);
        weft_instruction_set expected = (weft_instruction_set)most < best ? (weft_instruction_set)most : best;
        assert_int_equal(weft_processor_instruction_set(), expected);
        assert_int_equal(WEFT_DISPATCH(in_use)(), expected);
    }
    weft_processor_limit(WEFT_INSTRUCTION_SETS);
    assert_int_equal(weft_processor_instruction_set(), best);
    weft_processor_limit(before);
}

int test_processor(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(avx2_needs_fma_and_f16c),
        cmocka_unit_test(avx512_needs_what_avx2_needs),
        cmocka_unit_test(a_limit_holds_until_it_is_lifted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
