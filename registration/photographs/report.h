/* The report on photographs of a camera in the hand: one page with what was found of every one, and why some were left
 * out. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_REPORT_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_REPORT_H

#include "registration/photographs/photographs.h"

/* Writes index.html and its pictures into `folder`; `dataset` is the path of what was made. Errors: WEFT_SYSTEM. */
weft_code weft_photographs_report(const char *folder, const char *dataset, const weft_photographs_settings *settings,
                                  const weft_photograph_set *set, weft_error *error);

enum { WEFT_PHOTOGRAPHS_TEXT_SIZE = 280 };

/* What tells the tone curve, and how well, in words. Pure. */
void weft_photographs_describe_tone(const weft_photograph_set *set, char words[WEFT_PHOTOGRAPHS_TEXT_SIZE]);

/* How many samples are masked because they are clipped, too dark to be read, or hidden, in words. Pure. */
void weft_photographs_describe_masks(const weft_photograph_set *set, const weft_photographs_settings *settings,
                                     char words[WEFT_PHOTOGRAPHS_TEXT_SIZE]);

#endif
