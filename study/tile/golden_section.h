/* The largest value of a function of one variable. Private to study/. */
#ifndef WEFT_STUDY_TILE_GOLDEN_SECTION_H
#define WEFT_STUDY_TILE_GOLDEN_SECTION_H

/* Where `function` is largest within [low, high], to `tolerance`, if it has one peak there: by golden section (Kiefer
 * 1953). */
double weft_golden_section(double (*function)(void *context, double x), void *context, double low, double high,
                           double tolerance);

#endif
