/* Options of a command as a table: what each is called, what it takes and where its value goes. The table makes the
 * parser, its messages and the help. */
#ifndef WEFT_BASE_TEXT_OPTION_H
#define WEFT_BASE_TEXT_OPTION_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum weft_option_kind {
    WEFT_OPTION_OTHER,  /* what `read` makes of it */
    WEFT_OPTION_FLAG,   /* bool: true where the option is given; it takes no value */
    WEFT_OPTION_SWITCH, /* bool: "on" or "off"; true where the value is left out */
    WEFT_OPTION_WHOLE,  /* int: a whole number from low to high */
    WEFT_OPTION_SEED,   /* uint64_t: a whole number from 0 to 2^63 - 1 */
    WEFT_OPTION_NOISE,  /* int: the seed of a weave's noise, from 1 to 2^31 - 1 as the shaders hold it; "off": 0 */
    WEFT_OPTION_NUMBER, /* double: a number from low to high, divided by `divisor` unless that is 0 */
    WEFT_OPTION_ANGLE,  /* double, radians: degrees from low to high */
    WEFT_OPTION_SIZE,   /* int[2]: "WxH", each from 1 to high */
    WEFT_OPTION_PAIR,   /* double[2]: "X,Y", each above 0 and up to high */
    WEFT_OPTION_CHOICE, /* an enum of the size of int that counts from 0: one of `words` */
    WEFT_OPTION_TEXT,   /* const char *: the text itself, which must live on */
    WEFT_OPTION_INPUT,  /* the same, of a file that is read */
    WEFT_OPTION_OUTPUT, /* the same, of a file that is written */
    WEFT_OPTION_FOLDER, /* the same, of a folder that is written into */
    WEFT_OPTION_NAME    /* char *: a copy, owned; what was there is freed */
} weft_option_kind;

/* A table ends with {0}. */
typedef struct weft_option {
    const char *name;     /* without dashes; NULL: an argument that is known by its place */
    char letter;          /* its short name; 0: none */
    const char *argument; /* what the help calls its value; NULL: it takes none */
    const char *help;
    int group;         /* of the help */
    bool is_required;  /* one of the kinds that are text must not stay NULL */
    bool may_be_empty; /* the value may be left out */
    bool repeats;      /* an argument that is known by its place: takes all that follow, each by `read` */
    weft_option_kind kind;
    size_t offset; /* of the value in the target */
    double low, high, divisor;
    const char *const *words; /* end with NULL */
    const char *former_name;  /* an older name that is accepted, with a note; NULL: none */
    const char *gone;         /* not NULL: the option was removed, and this is to be done instead */
    const char *usual;        /* its value where it is not given, which the help adds; NULL: what the target has */
    /* Takes the place of what the kind would do. Errors: WEFT_BAD_USAGE with a message that names the option. */
    weft_code (*read)(const struct weft_option *option, const char *text, void *target, weft_error *error);
} weft_option;

/* Sets the value that `text` stands for (NULL: none was given). Errors: WEFT_BAD_USAGE naming the option, what it takes
 * and the text; WEFT_SYSTEM. */
weft_code weft_option_set(const weft_option *option, const char *text, void *target, weft_error *error);

/* ---- For `read` of an option. Errors: as above. ---- */

/* A number from low to high. */
weft_code weft_option_number(const char *name, const char *text, double low, double high, double *number,
                             weft_error *error);

/* A whole number from low to high. */
weft_code weft_option_whole(const char *name, const char *text, unsigned long long low, unsigned long long high,
                            unsigned long long *number, weft_error *error);

/* "X,Y" or "X,Y,Z" or more: `count` finite numbers. */
weft_code weft_option_numbers(const char *name, const char *text, int count, double *number, weft_error *error);

/* The index of the text in `words`, which end with NULL. */
weft_code weft_option_word(const char *name, const char *text, const char *const *words, int *index, weft_error *error);

/* A copy in the place of *owned, which is freed; NULL: none. Errors: WEFT_SYSTEM. */
weft_code weft_option_copy(const char *text, char **owned, weft_error *error);

#endif
