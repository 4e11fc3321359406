/* Tokens of weave files and stitch files. */
#ifndef WEFT_BASE_LEXER_H
#define WEFT_BASE_LEXER_H

#include "base/status.h"

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum weave_token_kind {
    WEAVE_WORD,      /* key or yarn type */
    WEAVE_NUMBER,    /* finite */
    WEAVE_STRING,    /* text without its quotes */
    WEAVE_PARAMETER, /* text of $name without the $ */
    WEAVE_SYMBOL,    /* one of { } , = */
    WEAVE_END
} weave_token_kind;

typedef struct weave_token {
    weave_token_kind kind;
    const char *text; /* into the file, `size` bytes, not terminated */
    size_t size;
    double number;
    int line, column; /* of its first character, from 1 */
} weave_token;

/* Reads tokens from a terminated text; `token` is the one not yet consumed. */
typedef struct weave_lexer {
    const char *path, *at, *line_start;
    int line;
    weave_token token;
    locale_t numbers; /* with a decimal point, whatever the locale of the program */
} weave_lexer;

/* Starts at the first token of `text`. Errors as weave_lexer_advance. weave_lexer_end follows in any case. */
weft_code weave_lexer_start(weave_lexer *lexer, const char *text, const char *path, weft_error *error);
void weave_lexer_end(weave_lexer *lexer);

/* Moves to the next token. Errors: WEFT_BAD_INPUT for a character, number, string or comment that is not one. */
weft_code weave_lexer_advance(weave_lexer *lexer, weft_error *error);

/* WEFT_BAD_INPUT "FILE:LINE:COLUMN: " and the message, at the current token. */
weft_code weave_lexer_fail(const weave_lexer *lexer, weft_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

bool weave_token_is_symbol(const weave_token *token, char symbol);
bool weave_token_is_word(const weave_token *token, const char *word);

/* At most this many bytes of a token appear in messages: the precision of "%.*s". */
int weave_token_shown(const weave_token *token);

#endif
