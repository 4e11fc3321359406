/* How long the multiply-adds of a pass over the samples take when nothing else is done: no loads, no stores, no
 * waiting for one another. No pass can be faster on this machine, whatever the order of its work.
 *
 * A pass needs, for every sample: of each lobe 3 for b = l . M v, 3 for h l, 1 each for h b, h b log2 b and the sum of
 * the model; 2 for rho and the residual; and one for every product of two of its 2 + 4 L columns, less
 * h_i l_a h_j l_b = h_i l_b h_j l_a (three for two different lobes) and less k k, which no trial changes. Logarithm and
 * power are not counted: what they cost depends on how they are approximated. */
#ifndef WEFT_BENCH_FIT_ARITHMETIC_FLOOR_H
#define WEFT_BENCH_FIT_ARITHMETIC_FLOOR_H

#include "base/processor.h"

/* Multiply-adds of a pass for one sample: 31, 71 and 124 for 1, 2 and 3 lobes. */
int pass_multiply_adds(int lobe_count);

/* Executes at least `count` multiply-adds of single floats with the vectors of an instruction set; a multiplication and
 * an addition where it knows no multiply-add. Returns something that depends on all of them. The set must be one that
 * the processor has. */
float execute_multiply_adds(weft_instruction_set set, double count);

#endif
