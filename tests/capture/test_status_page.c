/* The page that is written as the night goes. */
#include "tests/capture/small_session.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char *page_of(double lamp_drift)
{
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error = {0};
    size_t size;
    request.capture.status = "status";
    request.rig.settings.light_power_drift = lamp_drift;
    request.rig.settings.timeout_probability = 0.2;
    assert_int_equal(system("rm -rf session session.truth.h5 status"), 0);
    expect_ok(virtual_session_take(&request, NULL, NULL, &summary, &error), &error);
    char *page = (char *)scratch_load("status/index.html", &size);
    page[size] = '\0';
    char told[32];
    assert_true(summary.timeouts > 0);
    snprintf(told, sizeof told, ">%d<", summary.timeouts);
    assert_non_null(strstr(page, told));
    return page;
}

/* The number of a tile, which stands before what it says. */
static double drift_told(const char *page)
{
    const char *end = strstr(page, "largest change of the lamp");
    assert_non_null(end);
    while (*end != '%')
        end--;
    while (*end != '>')
        end--;
    return strtod(end + 1, NULL);
}

static void the_page_tells_photographs_viewpoints_faults_and_the_drift_of_the_lamp(void **state)
{
    (void)state;
    char *page = page_of(0);
    assert_non_null(strstr(page, "25 of 25"));
    assert_null(strstr(page, "ended early"));
    /* One picture for each of the five views. */
    for (int shot = 0; shot < SMALL_SHOTS; shot += 5) {
        char path[64];
        snprintf(path, sizeof path, "status/shot%d.png", shot);
        assert_int_equal(access(path, F_OK), 0);
        assert_non_null(strstr(page, path + strlen("status/")));
    }
    double still = drift_told(page);
    free(page);
    page = page_of(0.1);
    print_message("lamp that stands still: %.2f %%, lamp that varies by 10 %%: %.2f %%\n", still, drift_told(page));
    assert_true(still < 2);
    assert_true(drift_told(page) > 8);
    free(page);
}

static void a_run_that_ends_early_says_why(void **state)
{
    (void)state;
    virtual_session request = small_session_request();
    weft_capture_summary summary;
    weft_error error = {0};
    size_t size;
    request.capture.status = "status";
    request.rig.settings.timeout_probability = 0.9;
    request.rig.settings.rig.retries = 0;
    assert_int_equal(system("rm -rf session session.truth.h5 status"), 0);
    assert_int_equal(virtual_session_take(&request, NULL, NULL, &summary, &error), WEFT_SYSTEM);
    char *page = (char *)scratch_load("status/index.html", &size);
    page[size] = '\0';
    assert_non_null(strstr(page, "ended early: virtual camera: frame"));
    free(page);
}

int test_status_page(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_page_tells_photographs_viewpoints_faults_and_the_drift_of_the_lamp),
        cmocka_unit_test(a_run_that_ends_early_says_why),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
