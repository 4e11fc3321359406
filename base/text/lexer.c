#include "base/text/block_parser.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_NUMBER_SIZE = 64, MAX_SHOWN = 40 };

static bool is_word_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

weft_code weft_lexer_fail(const weft_lexer *lexer, weft_error *error, const char *format, ...)
{
    char what[WEFT_MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return weft_fail(error, WEFT_BAD_INPUT, "%s:%d:%d: %s", lexer->path, lexer->token.line, lexer->token.column, what);
}

int weft_token_shown(const weft_token *token)
{
    return token->size < MAX_SHOWN ? (int)token->size : MAX_SHOWN;
}

bool weft_token_is_symbol(const weft_token *token, char symbol)
{
    return token->kind == WEFT_TOKEN_SYMBOL && *token->text == symbol;
}

bool weft_token_is_word(const weft_token *token, const char *word)
{
    return token->kind == WEFT_TOKEN_WORD && strlen(word) == token->size && memcmp(token->text, word, token->size) == 0;
}

static void place_token(weft_lexer *lexer)
{
    lexer->token.text = lexer->at;
    lexer->token.size = 0;
    lexer->token.line = lexer->line;
    lexer->token.column = (int)(lexer->at - lexer->line_start) + 1;
}

static void step(weft_lexer *lexer)
{
    if (*lexer->at++ == '\n') {
        lexer->line++;
        lexer->line_start = lexer->at;
    }
}

static weft_code skip_comment(weft_lexer *lexer, weft_error *error)
{
    place_token(lexer);
    lexer->at += 2;
    while (*lexer->at && !(lexer->at[0] == '*' && lexer->at[1] == '/'))
        step(lexer);
    if (!*lexer->at)
        return weft_lexer_fail(lexer, error, "comment is not closed");
    lexer->at += 2;
    return WEFT_OK;
}

static weft_code skip_space(weft_lexer *lexer, weft_error *error)
{
    for (;;) {
        if (*lexer->at && strchr(" \t\r\n", *lexer->at))
            step(lexer);
        else if (lexer->at[0] == '/' && lexer->at[1] == '*')
            WEFT_TRY(skip_comment(lexer, error));
        else
            return WEFT_OK;
    }
}

static void read_word(weft_lexer *lexer, weft_token_kind kind)
{
    lexer->token.kind = kind;
    lexer->token.text = lexer->at;
    while (is_word_start(*lexer->at) || is_digit(*lexer->at))
        lexer->at++;
    lexer->token.size = (size_t)(lexer->at - lexer->token.text);
}

static const char *after_digits(const char *at)
{
    while (is_digit(*at))
        at++;
    return at;
}

/* End of the number at `start`: sign, digits, fraction, exponent; `start` itself where there is none. */
static const char *number_end(const char *start)
{
    const char *at = start + (*start == '-' || *start == '+');
    const char *digits = at;
    at = after_digits(at);
    bool any = at > digits;
    if (*at == '.') {
        const char *fraction = ++at;
        at = after_digits(at);
        any |= at > fraction;
    }
    if (!any)
        return start;
    if (*at == 'e' || *at == 'E') {
        const char *exponent = at + 1;
        exponent += *exponent == '-' || *exponent == '+';
        if (is_digit(*exponent))
            at = after_digits(exponent);
    }
    return at;
}

static weft_code read_number(weft_lexer *lexer, weft_error *error)
{
    const char *end = number_end(lexer->at);
    size_t size = (size_t)(end - lexer->at);
    char digits[MAX_NUMBER_SIZE];
    if (size == 0 || is_word_start(*end) || *end == '.')
        return weft_lexer_fail(lexer, error, "malformed number");
    if (size >= sizeof digits)
        return weft_lexer_fail(lexer, error, "number of %zu characters, at most %d", size, MAX_NUMBER_SIZE - 1);
    memcpy(digits, lexer->at, size);
    digits[size] = '\0';
    lexer->token.kind = WEFT_TOKEN_NUMBER;
    lexer->token.size = size;
    lexer->token.number = strtod_l(digits, NULL, lexer->numbers);
    lexer->at = end;
    if (!isfinite(lexer->token.number))
        return weft_lexer_fail(lexer, error, "number out of range");
    return WEFT_OK;
}

static weft_code read_string(weft_lexer *lexer, weft_error *error)
{
    const char *end = ++lexer->at;
    while ((unsigned char)*end >= ' ' && *end != '"')
        end++;
    if (*end != '"')
        return weft_lexer_fail(lexer, error, "string is not closed on its line");
    lexer->token.kind = WEFT_TOKEN_STRING;
    lexer->token.text = lexer->at;
    lexer->token.size = (size_t)(end - lexer->at);
    lexer->at = end + 1;
    return WEFT_OK;
}

static weft_code read_parameter(weft_lexer *lexer, weft_error *error)
{
    lexer->at++;
    if (!is_word_start(*lexer->at))
        return weft_lexer_fail(lexer, error, "a name must follow '$'");
    read_word(lexer, WEFT_TOKEN_PARAMETER);
    return WEFT_OK;
}

static weft_code read_symbol(weft_lexer *lexer, weft_error *error)
{
    unsigned char c = (unsigned char)*lexer->at;
    if (!strchr("{},=", c))
        return weft_lexer_fail(lexer, error, isprint(c) ? "unexpected character '%c'" : "unexpected byte %d", c);
    lexer->token.kind = WEFT_TOKEN_SYMBOL;
    lexer->token.size = 1;
    lexer->at++;
    return WEFT_OK;
}

weft_code weft_lexer_advance(weft_lexer *lexer, weft_error *error)
{
    WEFT_TRY(skip_space(lexer, error));
    place_token(lexer);
    char c = *lexer->at;
    if (c == '\0') {
        lexer->token.kind = WEFT_TOKEN_END;
    } else if (is_word_start(c)) {
        read_word(lexer, WEFT_TOKEN_WORD);
    } else if (is_digit(c) || c == '-' || c == '+' || c == '.') {
        return read_number(lexer, error);
    } else if (c == '"') {
        return read_string(lexer, error);
    } else if (c == '$') {
        return read_parameter(lexer, error);
    } else {
        return read_symbol(lexer, error);
    }
    return WEFT_OK;
}

weft_code weft_lexer_start(weft_lexer *lexer, const char *text, const char *path, weft_error *error)
{
    *lexer = (weft_lexer){.path = path, .at = text, .line_start = text, .line = 1};
    lexer->numbers = newlocale(LC_ALL_MASK, "C", NULL);
    if (!lexer->numbers)
        return weft_fail_memory(error, "locale of numbers", sizeof lexer->numbers);
    return weft_lexer_advance(lexer, error);
}

void weft_lexer_end(weft_lexer *lexer)
{
    if (lexer->numbers)
        freelocale(lexer->numbers);
    lexer->numbers = NULL;
}
