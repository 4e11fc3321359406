#include "tests/support/fake_hid.h"

#include <errno.h>
#include <fcntl.h>
#include <hidapi.h>
#include <linux/hidraw.h>
#include <linux/input.h>
#include <poll.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

enum { QUEUE = 64, REPORT_SIZE = 64 };

struct fake_hid {
    UMockdevTestbed *testbed;
    const fake_hid_kind *kind;
    UMockdevIoctlBase *handler;
    int number, master, slave;
    pthread_mutex_t mutex;
    pthread_cond_t rest; /* nothing of the kind is running */
    bool gone;
    int running; /* functions of the kind */
    fake_hid *next;
    unsigned char report[QUEUE][REPORT_SIZE];
    size_t size[QUEUE];
    int first, count;
};

/* A kernel opens a node before its device goes, or after. umockdev ends the process that opens it in between, so the
 * linker takes hid_open_path() through here. */
static pthread_mutex_t system_mutex = PTHREAD_MUTEX_INITIALIZER;

hid_device *__real_hid_open_path(const char *path);
hid_device *__wrap_hid_open_path(const char *path);

hid_device *__wrap_hid_open_path(const char *path)
{
    pthread_mutex_lock(&system_mutex);
    hid_device *device = __real_hid_open_path(path);
    pthread_mutex_unlock(&system_mutex);
    return device;
}

/* Threads of the testbed come here, too: an assertion of cmocka would jump into the stack of another. */
static void require(bool is_so, const char *what)
{
    if (is_so)
        return;
    fprintf(stderr, "fake_hid: %s: %s\n", what, strerror(errno));
    abort();
}

/* The testbed may call a handler late: what it was given stays until the process ends. */
static fake_hid *freed;

/* False where the device is unplugged; else what belongs to its kind stays until `leave`. */
static bool enter(fake_hid *hid)
{
    pthread_mutex_lock(&hid->mutex);
    bool plugged = !hid->gone;
    hid->running += plugged;
    pthread_mutex_unlock(&hid->mutex);
    return plugged;
}

static void leave(fake_hid *hid)
{
    pthread_mutex_lock(&hid->mutex);
    if (--hid->running == 0)
        pthread_cond_broadcast(&hid->rest);
    pthread_mutex_unlock(&hid->mutex);
}

static gboolean on_read(UMockdevIoctlBase *handler, UMockdevIoctlClient *client, gpointer data)
{
    (void)handler;
    fake_hid *hid = data;
    pthread_mutex_lock(&hid->mutex);
    if (hid->gone || hid->count == 0) {
        umockdev_ioctl_client_complete(client, -1, hid->gone ? EIO : EAGAIN);
    } else {
        UMockdevIoctlData *argument = umockdev_ioctl_client_get_arg(client);
        char token;
        size_t size = hid->size[hid->first], room = (size_t)argument->data_len;
        size = size < room ? size : room;
        umockdev_ioctl_data_update(argument, 0, hid->report[hid->first], size);
        hid->first = (hid->first + 1) % QUEUE;
        hid->count--;
        require(read(hid->slave, &token, 1) == 1, "no token read");
        umockdev_ioctl_client_complete(client, (glong)size, 0);
    }
    pthread_mutex_unlock(&hid->mutex);
    return TRUE;
}

static void answer(UMockdevIoctlData *argument, size_t offset, const void *bytes, size_t size, size_t total)
{
    UMockdevIoctlData *target = umockdev_ioctl_data_resolve(argument, 0, total, NULL);
    umockdev_ioctl_data_update(target, offset, (guint8 *)bytes, size);
    g_object_unref(target);
}

static gboolean on_write(UMockdevIoctlBase *handler, UMockdevIoctlClient *client, gpointer data)
{
    (void)handler;
    fake_hid *hid = data;
    UMockdevIoctlData *argument = umockdev_ioctl_client_get_arg(client);
    unsigned char bytes[1 + REPORT_SIZE];
    size_t size = (size_t)argument->data_len < sizeof bytes ? (size_t)argument->data_len : sizeof bytes;
    bool plugged = enter(hid);
    memcpy(bytes, argument->data, size);
    umockdev_ioctl_client_complete(client, plugged ? (glong)size : -1, plugged ? 0 : ENODEV);
    if (plugged && hid->kind->written)
        hid->kind->written(hid->kind->context, hid, bytes, size);
    if (plugged)
        leave(hid);
    return TRUE;
}

/* HIDIOCSFEATURE and HIDIOCGFEATURE, whose requests hold the size. */
static bool feature_report(const fake_hid *hid, UMockdevIoctlClient *client, unsigned long request)
{
    enum { SET = 6, GET = 7 };
    bool set = _IOC_TYPE(request) == 'H' && _IOC_NR(request) == SET && hid->kind->set_feature;
    bool get = _IOC_TYPE(request) == 'H' && _IOC_NR(request) == GET && hid->kind->get_feature;
    if (!set && !get)
        return false;
    size_t size = _IOC_SIZE(request);
    UMockdevIoctlData *bytes = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, size, NULL);
    unsigned char report[1 + REPORT_SIZE] = {0};
    if (set) {
        hid->kind->set_feature(hid->kind->context, bytes->data, size);
    } else {
        hid->kind->get_feature(hid->kind->context, report, size);
        umockdev_ioctl_data_update(bytes, 0, report, size);
    }
    g_object_unref(bytes);
    umockdev_ioctl_client_complete(client, (glong)size, 0);
    return true;
}

static gboolean describe_itself(const fake_hid *hid, UMockdevIoctlClient *client)
{
    unsigned long request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData *argument = umockdev_ioctl_client_get_arg(client);
    const int size = (int)hid->kind->descriptor_size;
    const struct hidraw_devinfo info = {BUS_USB, (short)hid->kind->vendor, (short)hid->kind->product};
    if (feature_report(hid, client, request))
        return TRUE;
    if (request == HIDIOCGRDESCSIZE)
        answer(argument, 0, &size, sizeof size, sizeof size);
    else if (request == HIDIOCGRDESC)
        answer(argument, 4, hid->kind->descriptor, hid->kind->descriptor_size, sizeof(struct hidraw_report_descriptor));
    else if (request == HIDIOCGRAWINFO)
        answer(argument, 0, &info, sizeof info, sizeof info);
    else
        return FALSE;
    umockdev_ioctl_client_complete(client, 0, 0);
    return TRUE;
}

static gboolean on_ioctl(UMockdevIoctlBase *handler, UMockdevIoctlClient *client, gpointer data)
{
    (void)handler;
    fake_hid *hid = data;
    if (!enter(hid)) {
        umockdev_ioctl_client_complete(client, -1, ENODEV);
        return TRUE;
    }
    gboolean answered = describe_itself(hid, client);
    leave(hid);
    return answered;
}

/* ---- Its place in the system ---- */

enum { PATH_COUNT = 4 };

/* Paths from the leaf to the root, as they must be removed. */
static void device_path(const fake_hid *hid, int index, char path[256])
{
    const char *root = "/devices/pci0000:00/usb1/1-";
    int n = hid->number;
    if (index == 0)
        snprintf(path, 256, "%s%d/1-%d:1.0/0003:%04X:%04X.%04d/hidraw/hidraw%d", root, n, n, hid->kind->vendor,
                 hid->kind->product, n, n);
    else if (index == 1)
        snprintf(path, 256, "%s%d/1-%d:1.0/0003:%04X:%04X.%04d", root, n, n, hid->kind->vendor, hid->kind->product, n);
    else if (index == 2)
        snprintf(path, 256, "%s%d/1-%d:1.0", root, n, n);
    else
        snprintf(path, 256, "%s%d", root, n);
}

static void add(fake_hid *hid, int index, const char *rest)
{
    char path[256], text[2048];
    GError *error = NULL;
    device_path(hid, index, path);
    snprintf(text, sizeof text, "P: %s\n%s\n", path, rest);
    if (!umockdev_testbed_add_from_string(hid->testbed, text, &error))
        require(false, error->message);
}

static void add_to_system(fake_hid *hid)
{
    const fake_hid_kind *kind = hid->kind;
    char text[1536], bytes[2 * 256 + 1] = "";
    require(kind->descriptor_size <= 256, "too long a descriptor");
    for (size_t k = 0; k < kind->descriptor_size; k++)
        sprintf(bytes + 2 * k, "%02X", kind->descriptor[k]);
    snprintf(text, sizeof text,
             "E: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nA: manufacturer=%s\\n\nA: product=%s\\n\nA: serial=%s\\n\n"
             "A: bcdDevice=0102\\n\nA: idVendor=%04x\\n\nA: idProduct=%04x\\n\n",
             kind->maker, kind->name, kind->serial, kind->vendor, kind->product);
    add(hid, 3, text);
    add(hid, 2, "E: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=00\\n\n");
    snprintf(text, sizeof text,
             "E: DRIVER=hid-generic\nE: HID_ID=0003:0000%04X:0000%04X\nE: HID_NAME=%s %s\n"
             "E: HID_PHYS=usb-0000:00:14.0-1/input0\nE: HID_UNIQ=%s\nE: SUBSYSTEM=hid\nH: report_descriptor=%s\n",
             kind->vendor, kind->product, kind->maker, kind->name, kind->serial, bytes);
    add(hid, 1, text);
    int n = hid->number;
    snprintf(text, sizeof text,
             "N: hidraw%d\nE: DEVNAME=/dev/hidraw%d\nE: MAJOR=240\nE: MINOR=%d\nE: SUBSYSTEM=hidraw\n"
             "A: dev=240:%d\\n\nL: device=../../../0003:%04X:%04X.%04d\n",
             n, n, n, n, kind->vendor, kind->product, n);
    add(hid, 0, text);
}

static void open_terminal(fake_hid *hid, const char *node)
{
    struct termios settings;
    hid->master = umockdev_testbed_get_dev_fd(hid->testbed, node);
    tcgetattr(hid->master, &settings);
    cfmakeraw(&settings);
    tcsetattr(hid->master, TCSANOW, &settings);
    hid->slave = open(ptsname(hid->master), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    require(hid->slave >= 0, "no terminal");
}

static fake_hid *create(UMockdevTestbed *testbed, int number, const fake_hid_kind *kind, char node[32])
{
    fake_hid *hid = calloc(1, sizeof *hid);
    require(hid, "no memory");
    snprintf(node, 32, "/dev/hidraw%d", number);
    hid->testbed = testbed;
    hid->kind = kind;
    hid->number = number;
    pthread_mutex_init(&hid->mutex, NULL);
    pthread_cond_init(&hid->rest, NULL);
    add_to_system(hid);
    return hid;
}

fake_hid *fake_hid_plug(UMockdevTestbed *testbed, int number, const fake_hid_kind *kind)
{
    char node[32];
    GError *error = NULL;
    pthread_mutex_lock(&system_mutex);
    fake_hid *hid = create(testbed, number, kind, node);
    hid->handler = umockdev_ioctl_base_new();
    g_signal_connect(hid->handler, "handle-ioctl", G_CALLBACK(on_ioctl), hid);
    g_signal_connect(hid->handler, "handle-read", G_CALLBACK(on_read), hid);
    g_signal_connect(hid->handler, "handle-write", G_CALLBACK(on_write), hid);
    if (!umockdev_testbed_attach_ioctl(testbed, node, hid->handler, &error))
        require(false, error->message);
    open_terminal(hid, node);
    pthread_mutex_unlock(&system_mutex);
    return hid;
}

fake_hid *fake_hid_plug_forbidden(UMockdevTestbed *testbed, int number, const fake_hid_kind *kind)
{
    char node[32];
    fake_hid *hid = create(testbed, number, kind, node);
    open_terminal(hid, node);
    require(fchmod(hid->slave, 0600) == 0, "no permissions");
    return hid;
}

/* poll() is not mocked: a byte in the terminal stands for each report. */
void fake_hid_push(fake_hid *hid, const unsigned char *report, size_t size)
{
    pthread_mutex_lock(&hid->mutex);
    if (hid->gone) {
        pthread_mutex_unlock(&hid->mutex);
        return;
    }
    require(hid->count < QUEUE && size <= REPORT_SIZE, "too many reports wait");
    int last = (hid->first + hid->count++) % QUEUE;
    memcpy(hid->report[last], report, size);
    hid->size[last] = size;
    require(write(hid->master, "T", 1) == 1, "no token written");
    struct pollfd arrived = {hid->slave, POLLIN, 0};
    require(poll(&arrived, 1, 5000) == 1, "no token arrives");
    pthread_mutex_unlock(&hid->mutex);
}

/* The master's number stays taken, by nothing, for the testbed to close. */
void fake_hid_unplug(fake_hid *hid)
{
    pthread_mutex_lock(&hid->mutex);
    hid->gone = true;
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nothing, hid->master);
    close(nothing);
    pthread_mutex_unlock(&hid->mutex);
    pthread_mutex_lock(&system_mutex);
    for (int index = 0; index < PATH_COUNT; index++) {
        char path[256], full[300];
        device_path(hid, index, path);
        snprintf(full, sizeof full, "/sys%s", path);
        umockdev_testbed_uevent(hid->testbed, full, "remove");
        umockdev_testbed_remove_device(hid->testbed, full);
    }
    pthread_mutex_unlock(&system_mutex);
}

/* The terminal stays open: the testbed never forgets its number and would trip over it. */
void fake_hid_free(fake_hid *hid)
{
    pthread_mutex_lock(&hid->mutex);
    while (hid->running > 0)
        pthread_cond_wait(&hid->rest, &hid->mutex);
    pthread_mutex_unlock(&hid->mutex);
    g_clear_object(&hid->handler);
    hid->next = freed;
    freed = hid;
}
