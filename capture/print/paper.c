#include "capture/print/paper.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const double weft_paper_margin_mm = 5;

static const double smallest_side_mm = 40, largest_side_mm = 2000;

static const weft_paper known_paper[] = {{"A4", 210, 297}, {"letter", 215.9, 279.4}};

static bool is_side(double side_mm)
{
    return side_mm >= smallest_side_mm && side_mm <= largest_side_mm;
}

/* "WxH" and nothing else. */
static bool parse_sides(const char *text, weft_paper *paper)
{
    char *end;
    paper->width_mm = strtod(text, &end);
    if (end == text || *end != 'x')
        return false;
    const char *height = end + 1;
    paper->height_mm = strtod(height, &end);
    if (end == height || *end || !is_side(paper->width_mm) || !is_side(paper->height_mm))
        return false;
    snprintf(paper->name, sizeof paper->name, "%g x %g mm", paper->width_mm, paper->height_mm);
    return true;
}

weft_code weft_paper_parse(const char *text, weft_paper *paper, weft_error *error)
{
    for (size_t i = 0; i < sizeof known_paper / sizeof known_paper[0]; i++) {
        if (strcasecmp(text, known_paper[i].name) == 0) {
            *paper = known_paper[i];
            return WEFT_OK;
        }
    }
    if (parse_sides(text, paper))
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE, "--paper needs A4, letter or WxH with sides from %g to %g mm, not '%s'",
                     smallest_side_mm, largest_side_mm, text);
}

double weft_paper_printable_width(const weft_paper *paper)
{
    return paper->width_mm - 2 * weft_paper_margin_mm;
}

double weft_paper_printable_height(const weft_paper *paper)
{
    return paper->height_mm - 2 * weft_paper_margin_mm;
}
