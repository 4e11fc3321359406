#include "compress/fit/kernels.h"

#define TABLE(set)                                                                                                     \
    WEFT_DECLARE_FIT_KERNELS(set);                                                                                     \
    static const weft_fit_kernels kernels_##set = {                                                                    \
        weft_gram_accumulate_##set,  weft_gather_samples_##set,  weft_gather_weigh_##set,  weft_gather_compare_##set,  \
        weft_gather_brightest_##set, weft_gram_evaluate_##set,   weft_screen_load_##set,   weft_screen_try_##set,      \
        weft_linear_digest_##set,    weft_linear_residual_##set, weft_linear_normal_##set, weft_fit_normal_##set}

TABLE(baseline);
#if defined(__x86_64__)
TABLE(avx2);
TABLE(avx512);
#endif

const weft_fit_kernels *weft_fit_kernels_of(weft_instruction_set set)
{
#if defined(__x86_64__)
    if (set == WEFT_AVX512)
        return &kernels_avx512;
    if (set == WEFT_AVX2)
        return &kernels_avx2;
#endif
    (void)set;
    return &kernels_baseline;
}
