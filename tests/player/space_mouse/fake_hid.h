/* A SpaceMouse behind the real libhidapi, without hardware: umockdev serves its hidraw node. The program must run under
 * umockdev-wrapper. */
#ifndef WEFT_TESTS_FAKE_HID_H
#define WEFT_TESTS_FAKE_HID_H

#include <stddef.h>
#include <umockdev.h>

typedef struct fake_hid fake_hid;

/* Plugs it in as /dev/hidraw<number>; asserts. */
fake_hid *fake_hid_plug(UMockdevTestbed *testbed, int number);
/* The same, but only the user of this process may open the node; it has no reports. */
fake_hid *fake_hid_plug_forbidden(UMockdevTestbed *testbed, int number);
/* Queues an input report; returns once poll() sees it. */
void fake_hid_push(fake_hid *hid, const unsigned char *report, size_t size);
/* The cable is pulled: readers get an error, and it is no longer listed. */
void fake_hid_unplug(fake_hid *hid);
/* After fake_hid_unplug. */
void fake_hid_free(fake_hid *hid);

#endif
