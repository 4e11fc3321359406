#include "base/text/light_list.h"

#include "base/numeric/statistics.h"
#include "base/text/csv.h"
#include "base/text/text_file.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static const double unit_tolerance = 0.05, nearest_mm = 20;

/* ---- Names ---- */

/* After the last separator of any system. */
static const char *without_folders(const char *path)
{
    const char *name = path;
    for (const char *at = path; *at; at++) {
        if (*at == '/' || *at == '\\')
            name = at + 1;
    }
    return name;
}

static size_t stem_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? (size_t)(dot - name) : strlen(name);
}

static bool same_stem(const char *a, const char *b)
{
    return stem_length(a) == stem_length(b) && strncasecmp(a, b, stem_length(a)) == 0;
}

int weft_light_list_find(const weft_light_list *list, const char *photograph)
{
    const char *name = without_folders(photograph);
    int found = -1, count = 0;
    for (int i = 0; i < list->count; i++) {
        if (strcasecmp(list->row[i].file, name) == 0)
            return i;
        if (same_stem(list->row[i].file, name))
            found = i, count++;
    }
    return count == 1 ? found : -1;
}

/* ---- Rows ---- */

static weft_code fail_at(const weft_light_list *list, int line, const char *what, const char *name, weft_error *error)
{
    return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: %s '%s'", list->path, line, what, name);
}

/* Takes `row` with a copy of the name. There is room. */
static weft_code add_row(weft_light_list *list, const char *name, weft_listed_light row, weft_error *error)
{
    name = without_folders(name);
    if (!*name)
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: no name of a photograph", list->path, row.line);
    for (int i = 0; i < list->count; i++) {
        const char *other = list->row[i].file;
        if (other && strcasecmp(other, name) == 0)
            return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: '%s' is listed already in line %d", list->path, row.line,
                             name, list->row[i].line);
    }
    if (row.has_light && !(weft_length(row.light) > 0))
        return fail_at(list, row.line, "no direction to the lamp of", name, error);
    row.file = strdup(name);
    if (!row.file)
        return weft_fail_memory(error, name, strlen(name));
    list->row[list->count++] = row;
    return WEFT_OK;
}

static weft_code allocate(weft_light_list *list, size_t rows, weft_error *error)
{
    list->row = calloc(rows + 1, sizeof *list->row);
    return list->row ? WEFT_OK : weft_fail_memory(error, list->path, rows * sizeof *list->row);
}

/* ---- .lp files ---- */

static bool separates(char letter)
{
    return isspace((unsigned char)letter) || letter == ',' || letter == ';';
}

/* Cuts the last word off a line, and the gap before it; NULL where there is none. The gap is of blanks, or of one kind
 * of mark and blanks: *mark is that, or ' '. */
static char *cut_last_word(char *line, char *mark)
{
    char *word = line + strlen(line);
    while (word > line && !separates(word[-1]))
        word--;
    if (!*word)
        return NULL;
    *mark = ' ';
    for (char *gap = word; gap > line && separates(gap[-1]); *gap = 0) {
        if (!isspace((unsigned char)*--gap))
            *mark = *gap;
    }
    return word;
}

static bool read_number(const char *text, double *value)
{
    if (!text)
        return false;
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

/* Whether a comma stands between two digits. */
static bool has_decimal_comma(const char *text)
{
    for (const char *at = strchr(text, ','); at; at = strchr(at + 1, ',')) {
        if (at > text && isdigit((unsigned char)at[-1]) && isdigit((unsigned char)at[1]))
            return true;
    }
    return false;
}

static weft_code fail_row(const weft_light_list *list, int number, bool has_commas, weft_error *error)
{
    return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: expected a name and three numbers%s", list->path, number,
                     has_commas ? "; if its commas are decimal, write points" : "");
}

/* Whether the name that was left of a line ends in a number: then the line holds more than three, halves of decimals.
 */
static bool ends_in_number(const char *name)
{
    double value;
    const char *comma = strrchr(name, ',');
    return comma && read_number(comma + 1, &value);
}

static char *trimmed(char *text)
{
    while (isspace((unsigned char)*text) || *text == '"')
        text++;
    char *end = text + strlen(text);
    while (end > text && (isspace((unsigned char)end[-1]) || end[-1] == '"'))
        *--end = 0;
    return text;
}

/* Name and three numbers; a name may hold blanks, so the line is read from its end. All gaps are of one kind: where
 * some are blanks or semicolons and some are commas, a comma is that of a decimal. */
static weft_code read_lp_row(weft_light_list *list, char *line, int number, weft_error *error)
{
    double value[3];
    char mark[3];
    bool has_commas = has_decimal_comma(line);
    for (int i = 2; i >= 0; i--) {
        char *word = cut_last_word(line, &mark[i]);
        if (!word || !read_number(word, &value[i]) || mark[i] != mark[2])
            return fail_row(list, number, has_commas, error);
        if (word == line) /* nothing stands before it */
            *line = 0;
    }
    if (mark[0] == ',' && ends_in_number(line))
        return fail_row(list, number, true, error);
    weft_listed_light row = {.line = number, .has_light = true, .light = {value[0], value[1], value[2]}};
    return add_row(list, trimmed(line), row, error);
}

static size_t count_lines(const char *text)
{
    size_t count = 1;
    for (; *text; text++)
        count += *text == '\n' || *text == '\r';
    return count;
}

static bool is_comment(const char *line)
{
    return *line == '#' || *line == '%' || strncmp(line, "//", 2) == 0;
}

/* A comment behind the numbers. A name may hold the mark, too, but no number follows it in a name. */
static void cut_comment(char *line)
{
    char *mark = strrchr(line, '#');
    double value;
    const char *last = strrchr(line, ' ');
    if (mark && mark > line && isspace((unsigned char)mark[-1]) && !(last && read_number(last + 1, &value)))
        *mark = 0;
}

/* Lines of old computers end in a carriage return alone. */
static void unify_line_ends(char *text)
{
    for (; *text; text++) {
        if (*text == '\r')
            *text = text[1] == '\n' ? ' ' : '\n';
    }
}

static weft_code read_lp_lines(weft_light_list *list, char *text, weft_error *error)
{
    double announced = -1;
    int number = 0, first = 0;
    unify_line_ends(text);
    for (char *rest = text; rest;) {
        char *line = trimmed(strsep(&rest, "\n"));
        cut_comment(line);
        line = trimmed(line);
        number++;
        if (!*line || is_comment(line))
            continue;
        if (announced < 0 && !read_number(line, &announced))
            return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: an .lp file begins with the number of its photographs",
                             list->path, number);
        if (!first)
            first = number;
        else
            WEFT_TRY(read_lp_row(list, line, number, error));
    }
    if (announced == list->count || list->count == 0)
        return WEFT_OK;
    return weft_lines_add(&list->notes, error, "%s:%d: %g photographs are announced, but %d are listed", list->path,
                          first, announced, list->count);
}

static weft_code read_lp(weft_light_list *list, weft_error *error)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    char *text;
    WEFT_TRY(weft_text_file_read(list->path, &text, error));
    list->of_pictures = true;
    weft_code code = allocate(list, count_lines(text), error);
    bool marked = strncmp(text, byte_order_mark, 3) == 0;
    if (code == WEFT_OK)
        code = read_lp_lines(list, text + (marked ? 3 : 0), error);
    free(text);
    return code;
}

/* ---- Tables ---- */

typedef struct columns {
    int file, x, y, z, theta_light, phi_light, theta_view, phi_view, uncertainty;
} columns;

static columns columns_of(const weft_csv *table)
{
    columns c = {.file = weft_csv_column(table, "file"),
                 .x = weft_csv_column(table, "x"),
                 .y = weft_csv_column(table, "y"),
                 .z = weft_csv_column(table, "z"),
                 .theta_light = weft_csv_column(table, "theta_light_deg"),
                 .phi_light = weft_csv_column(table, "phi_light_deg"),
                 .theta_view = weft_csv_column(table, "theta_view_deg"),
                 .phi_view = weft_csv_column(table, "phi_view_deg"),
                 .uncertainty = weft_csv_column(table, "uncertainty_deg")};
    return c;
}

static weft_code read_direction(const weft_csv *table, int row, int theta_column, int phi_column, weft_vec3 *direction,
                                weft_error *error)
{
    double theta, phi;
    WEFT_TRY(weft_csv_number(table, row, theta_column, &theta, error));
    WEFT_TRY(weft_csv_number(table, row, phi_column, &phi, error));
    theta *= WEFT_PI / 180, phi *= WEFT_PI / 180;
    *direction = weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
    return WEFT_OK;
}

static weft_code read_table_row(weft_light_list *list, const weft_csv *table, int at, const columns *c,
                                weft_error *error)
{
    weft_listed_light row = {.line = table->line[at]};
    row.has_light = c->z >= 0 || c->theta_light >= 0;
    row.has_view = c->theta_view >= 0;
    if (c->z >= 0) {
        double value[3];
        const int column[3] = {c->x, c->y, c->z};
        for (int i = 0; i < 3; i++)
            WEFT_TRY(weft_csv_number(table, at, column[i], &value[i], error));
        row.light = weft_vec3_of(value[0], value[1], value[2]);
    } else if (row.has_light)
        WEFT_TRY(read_direction(table, at, c->theta_light, c->phi_light, &row.light, error));
    if (row.has_view)
        WEFT_TRY(read_direction(table, at, c->theta_view, c->phi_view, &row.view, error));
    if (c->uncertainty >= 0)
        WEFT_TRY(weft_csv_number(table, at, c->uncertainty, &row.uncertainty_deg, error));
    return add_row(list, weft_csv_text(table, at, c->file), row, error);
}

static weft_code read_table(weft_light_list *list, weft_error *error)
{
    weft_csv table;
    WEFT_TRY(weft_csv_read(list->path, true, &table, error));
    columns c = columns_of(&table);
    weft_code code = WEFT_OK;
    bool light = (c.x >= 0 && c.y >= 0 && c.z >= 0) || (c.theta_light >= 0 && c.phi_light >= 0);
    if (c.file < 0 || !(light || (c.theta_view >= 0 && c.phi_view >= 0)))
        code = weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' lacks columns: file, and x, y, z or theta_light_deg, phi_light_deg or theta_view_deg, "
                         "phi_view_deg",
                         list->path);
    if (!light)
        c.z = c.theta_light = -1;
    else if (c.x < 0 || c.y < 0)
        c.z = -1;
    if (c.phi_view < 0)
        c.theta_view = -1;
    if (code == WEFT_OK)
        code = allocate(list, (size_t)table.row_count, error);
    for (int row = 0; code == WEFT_OK && row < table.row_count; row++)
        code = read_table_row(list, &table, row, &c, error);
    weft_csv_free(&table);
    return code;
}

/* ---- The list ---- */

/* No lamp stands so near to a sample that its position in mm could be taken for a direction, whatever its length. */
static weft_code tell_positions(weft_light_list *list, weft_error *error)
{
    double *length = malloc((size_t)list->count * sizeof *length), shortest = INFINITY, longest = 0;
    size_t count = 0;
    if (!length)
        return weft_fail_memory(error, list->path, (size_t)list->count * sizeof *length);
    for (int i = 0; i < list->count; i++) {
        if (!list->row[i].has_light)
            continue;
        length[count] = weft_length(list->row[i].light);
        shortest = fmin(shortest, length[count]);
        longest = fmax(longest, length[count++]);
    }
    list->positions = count > 0 && weft_quantile(length, count, 0.5) >= nearest_mm;
    free(length);
    if (list->positions || count == 0)
        return WEFT_OK;
    for (int i = 0; i < list->count; i++) {
        if (list->row[i].has_light)
            list->row[i].light = weft_unit(list->row[i].light);
    }
    if (shortest > 1 - unit_tolerance && longest < 1 + unit_tolerance)
        return WEFT_OK;
    return weft_lines_add(&list->notes, error,
                          "'%s': its vectors are %.3g to %.3g long and taken as directions; positions are in mm",
                          list->path, shortest, longest);
}

weft_code weft_light_list_read(const char *path, weft_light_list *list, weft_error *error)
{
    const char *ending = strrchr(path, '.');
    *list = (weft_light_list){.path = strdup(path)};
    weft_code code = list->path ? WEFT_OK : weft_fail_memory(error, path, strlen(path));
    if (code == WEFT_OK)
        code = ending && strcasecmp(ending, ".csv") == 0 ? read_table(list, error) : read_lp(list, error);
    if (code == WEFT_OK && list->count == 0)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' lists no photograph", path);
    if (code == WEFT_OK)
        code = tell_positions(list, error);
    if (code != WEFT_OK)
        weft_light_list_free(list);
    return code;
}

void weft_light_list_free(weft_light_list *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->row[i].file);
    free(list->row);
    free(list->path);
    weft_lines_free(&list->notes);
    *list = (weft_light_list){0};
}
