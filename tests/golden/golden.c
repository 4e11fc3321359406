/* golden good FOLDER: each NAME.values in it is what the file NAME holds.
 * golden bad FOLDER: each NAME.message in it is what `weft verify -q NAME` says: the line and the exit code.
 * golden print FILE: what a file of Weft holds, decoded.
 * golden compare EXPECTED ACTUAL: whether two texts say the same. */
#include "btf/file_kind.h"
#include "inspect/inspect.h"
#include "tests/golden/compare.h"
#include "tests/golden/print.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NAME_SIZE = 256 };

void print_vector(FILE *out, weft_vec3 vector)
{
    fprintf(out, " %.9g %.9g %.9g", vector.x, vector.y, vector.z);
}

void print_colour(FILE *out, weft_rgb colour)
{
    fprintf(out, " %.9g %.9g %.9g", colour.r, colour.g, colour.b);
}

static weft_code print(const char *path, FILE *out, weft_error *error)
{
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(path, &kind, error));
    switch (kind) {
    case WEFT_FILE_MATERIAL:
        return print_material(path, out, error);
    case WEFT_FILE_DATASET:
        return print_dataset(path, out, error);
    case WEFT_FILE_SESSION:
        return print_session(path, out, error);
    case WEFT_FILE_WEAVE:
        return print_weave(path, out, error);
    case WEFT_FILE_STITCH:
        return print_stitch(path, out, error);
    case WEFT_FILE_MICROCYLINDER:
        return print_microcylinder(path, out, error);
    default:
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is of no kind that has golden files", path);
    }
}

/* ---- Good files ---- */

static bool complain(const char *file, const char *what)
{
    fprintf(stderr, "%s: %s\n", file, what);
    return false;
}

static bool is_accepted(const char *file, weft_code code, json_t *description, const weft_error *error)
{
    json_decref(description);
    return code == WEFT_OK || complain(file, error->message);
}

static bool check_good(const char *file, const char *values)
{
    weft_error error = {0};
    json_t *description;
    weft_code code = weft_inspect(file, &description, &error);
    if (!is_accepted(file, code, description, &error))
        return false;
    code = weft_verify(file, NULL, &description, &error);
    if (!is_accepted(file, code, description, &error))
        return false;
    FILE *printed = tmpfile();
    if (!printed)
        return complain(file, "no temporary file");
    bool same = print(file, printed, &error) == WEFT_OK || complain(file, error.message);
    rewind(printed);
    same = same && golden_compare(values, printed);
    fclose(printed);
    return same;
}

/* ---- Bad files ---- */

/* Where a library chose the last words of a message, it ends with "...". */
static bool same_message(const char *expected, const char *actual)
{
    size_t length = strlen(expected);
    if (length > 3 && strcmp(expected + length - 3, "...") == 0)
        return strncmp(expected, actual, length - 3) == 0 && strlen(actual) > length - 3;
    return strcmp(expected, actual) == 0;
}

/* Three lines: the command, the message, the exit code. */
static bool read_transcript(const char *path, char message[WEFT_MESSAGE_SIZE], int *code)
{
    char command[NAME_SIZE], prompt[] = "$ weft verify -q ";
    FILE *file = fopen(path, "r");
    bool read = file && fgets(command, sizeof command, file) && strncmp(command, prompt, sizeof prompt - 1) == 0 &&
                fscanf(file, "weft verify: %511[^\n]\nexit code %d", message, code) == 2;
    if (file)
        fclose(file);
    return read;
}

static bool check_bad(const char *file, const char *transcript)
{
    char expected[WEFT_MESSAGE_SIZE];
    int expected_code;
    weft_error error = {0};
    json_t *description;
    if (!read_transcript(transcript, expected, &expected_code))
        return complain(transcript, "cannot be read");
    weft_code code = weft_verify(file, NULL, &description, &error);
    json_decref(description);
    if ((int)weft_class_of(code) != expected_code || !same_message(expected, error.message)) {
        fprintf(stderr, "%s: code %d and '%s', expected %d and '%s'\n", file, (int)code, error.message, expected_code,
                expected);
        return false;
    }
    /* Who reads less of it may not see what is wrong. */
    weft_inspect(file, &description, &error);
    json_decref(description);
    return strchr(error.message, '\n') == NULL || complain(file, "more than one line is said");
}

/* ---- Folders ---- */

typedef bool check_function(const char *file, const char *expectation);

/* Takes `ending` off a name; false where the name has another. */
static bool without_ending(const char *name, const char *ending, char file[NAME_SIZE])
{
    size_t length = strlen(name), tail = strlen(ending);
    if (length <= tail || strcmp(name + length - tail, ending) != 0)
        return false;
    snprintf(file, NAME_SIZE, "%.*s", (int)(length - tail), name);
    return true;
}

static int check_folder(const char *folder, const char *ending, check_function *check)
{
    DIR *names = chdir(folder) == 0 ? opendir(".") : NULL;
    int passed = 0, failed = 0;
    for (struct dirent *entry; names && (entry = readdir(names));) {
        char file[NAME_SIZE];
        if (!without_ending(entry->d_name, ending, file))
            continue;
        if (check(file, entry->d_name))
            passed++;
        else
            failed++;
    }
    if (names)
        closedir(names);
    printf("%s: %d passed, %d failed\n", folder, passed, failed);
    return passed > 0 && failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

static int print_file(const char *path)
{
    weft_error error = {0};
    if (print(path, stdout, &error) == WEFT_OK)
        return EXIT_SUCCESS;
    complain(path, error.message);
    return EXIT_FAILURE;
}

static int compare_files(const char *expected, const char *actual_path)
{
    FILE *actual = fopen(actual_path, "r");
    bool same = actual ? golden_compare(expected, actual) : complain(actual_path, "cannot be opened");
    if (actual)
        fclose(actual);
    return same ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    const char *command = argc > 1 ? argv[1] : "";
    if (argc == 3 && strcmp(command, "good") == 0)
        return check_folder(argv[2], ".values", check_good);
    if (argc == 3 && strcmp(command, "bad") == 0)
        return check_folder(argv[2], ".message", check_bad);
    if (argc == 3 && strcmp(command, "print") == 0)
        return print_file(argv[2]);
    if (argc == 4 && strcmp(command, "compare") == 0)
        return compare_files(argv[2], argv[3]);
    fprintf(stderr, "usage: golden good|bad FOLDER, golden print FILE, golden compare EXPECTED ACTUAL\n");
    return 2;
}
