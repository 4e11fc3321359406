/* The fake stage on a USB cable: umockdev serves its hidraw node to the real libhidapi. */
#ifndef WEFT_TESTS_CAPTURE_FAKE_CONTROLLER_H
#define WEFT_TESTS_CAPTURE_FAKE_CONTROLLER_H

#include "tests/capture/fake_stage.h"
#include "tests/support/fake_hid.h"

typedef struct fake_controller {
    fake_stage stage;
    UMockdevTestbed *testbed;
    fake_hid_kind kind;
    fake_hid *hid;
    int number, plugged; /* of its node; how often it was plugged in again */
    bool stays_away;     /* once unplugged, it is not plugged in again */
    bool ending;
    pthread_t hand; /* that pulls the cable */
} fake_controller;

/* Plugs it in. */
void fake_controller_start(fake_controller *controller, UMockdevTestbed *testbed);
void fake_controller_end(fake_controller *controller);

#endif
