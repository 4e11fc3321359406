/* Values of options. What cannot be understood is wrong usage: argp_error says so and does not return.
 * `option` is the option's long name without dashes. */
#ifndef WEFT_CLI_ARGUMENTS_H
#define WEFT_CLI_ARGUMENTS_H

#include <argp.h>
#include <stdbool.h>

/* A finite number from low to high. */
double parse_number(const char *option, const char *text, double low, double high, struct argp_state *state);

/* "X,Y" or "X,Y,Z": `count` finite numbers. */
void parse_numbers(const char *option, const char *text, int count, double *numbers, struct argp_state *state);

/* A whole number from low to high. */
unsigned long long parse_whole(const char *option, const char *text, unsigned long long low, unsigned long long high,
                               struct argp_state *state);

/* "WxH", each from 1 to `limit`. */
void parse_size(const char *option, const char *text, int limit, int *width, int *height, struct argp_state *state);

/* "X,Y": tiles of a weave across a material, each above 0 and up to 1e6. */
void parse_tiles(const char *option, const char *text, double *tiles_u, double *tiles_v, struct argp_state *state);

/* The seed of the irregularities of a weave, as the shaders hold it: a whole number from 1 to 2^31 - 1; "off": 0. */
int parse_noise_seed(const char *option, const char *text, struct argp_state *state);

/* "on" or "off". */
bool parse_switch(const char *option, const char *text, struct argp_state *state);

/* Refuses an output that is an input of the command, by whatever path; either may be NULL. */
void refuse_same_file(const char *output, const char *input, struct argp_state *state);

#endif
