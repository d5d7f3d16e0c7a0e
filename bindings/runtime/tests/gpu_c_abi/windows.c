/* Windows of X11 that come and go while the device stays: what they show, sizes, memory. Xlib is opened as it runs: no headers. */
#define _GNU_SOURCE
#include "check.h"

#include <dlfcn.h>
#include <unistd.h>

/* As Xlib has it, up to what is read here. */
typedef struct Image {
    int width, height, xoffset, format;
    char *data;
    int byte_order, bitmap_unit, bitmap_bit_order, bitmap_pad, depth, bytes_per_line, bits_per_pixel;
} Image;

static void *(*open_display)(const char *);
static int (*close_display)(void *);
static unsigned long (*root_window)(void *);
static unsigned long (*create_window)(void *, unsigned long, int, int, unsigned, unsigned, unsigned, unsigned long, unsigned long);
static int (*map_window)(void *, unsigned long);
static int (*resize_window)(void *, unsigned long, unsigned, unsigned);
static int (*destroy_window)(void *, unsigned long);
static int (*sync_display)(void *, int);
static Image *(*get_image)(void *, unsigned long, int, int, unsigned, unsigned, unsigned long, int);
static int (*free_memory)(void *);

static void find(void *library, const char *name, void *function) {
    void *found = dlsym(library, name);
    EXPECT(found != NULL);
    memcpy(function, &found, sizeof found);
}

static void open_xlib(void) {
    void *library = dlopen("libX11.so.6", RTLD_NOW);
    int (*init_threads)(void);
    EXPECT(library != NULL);
    find(library, "XInitThreads", &init_threads);
    find(library, "XOpenDisplay", &open_display);
    find(library, "XCloseDisplay", &close_display);
    find(library, "XDefaultRootWindow", &root_window);
    find(library, "XCreateSimpleWindow", &create_window);
    find(library, "XMapWindow", &map_window);
    find(library, "XResizeWindow", &resize_window);
    find(library, "XDestroyWindow", &destroy_window);
    find(library, "XSync", &sync_display);
    find(library, "XGetImage", &get_image);
    find(library, "XFree", &free_memory);
    EXPECT(init_threads() != 0);
}

/* Bytes of a window's pixels that are not those of a picture, once it shows what was drawn last. */
static int differing(void *display, unsigned long window, const unsigned char *pixels) {
    int count = 0;
    /* 2: ZPixmap. */
    Image *image = get_image(display, window, 0, 0, WIDTH, HEIGHT, ~0ul, 2);
    EXPECT(image != NULL && image->bits_per_pixel == 32);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const unsigned char *shown = (const unsigned char *)image->data + y * image->bytes_per_line + 4 * x;
            const unsigned char *drawn = pixels + 4 * (y * WIDTH + x);
            count += shown[2] != drawn[0] || shown[1] != drawn[1] || shown[0] != drawn[2];
        }
    }
    free(image->data);
    free_memory(image);
    return count;
}

static void expect_shown(void *display, unsigned long window, const unsigned char *pixels) {
    int count = -1;
    for (int tries = 0; count != 0 && tries < 100; tries++) {
        usleep(tries * 1000);
        sync_display(display, 0);
        count = differing(display, window, pixels);
    }
    if (count != 0) {
        fprintf(stderr, "%d pixels of the window are others than the picture's\n", count);
        exit(1);
    }
}

/* A window that is opened, drawn, resized, drawn and closed. */
static void cycle(Stage *stage, void *display, const unsigned char *pixels) {
    SubsurfSurface *surface = NULL;
    unsigned long window = create_window(display, root_window(display), 0, 0, WIDTH, HEIGHT, 0, 0, 0);
    map_window(display, window);
    sync_display(display, 0);
    OK(subsurf_surface_open(stage->gpu, window, WIDTH, HEIGHT, &surface));
    OK(subsurf_renderer_draw_surface(stage->renderer, &stage->frame, surface, NULL));
    if (pixels != NULL) {
        expect_shown(display, window, pixels);
        resize_window(display, window, WIDTH / 2, HEIGHT);
        sync_display(display, 0);
        OK(subsurf_surface_resize(surface, WIDTH / 2, HEIGHT));
        OK(subsurf_renderer_draw_surface(stage->renderer, &stage->frame, surface, NULL));
        resize_window(display, window, WIDTH, HEIGHT);
        sync_display(display, 0);
        OK(subsurf_surface_resize(surface, WIDTH, HEIGHT));
        OK(subsurf_renderer_draw_surface(stage->renderer, &stage->frame, surface, NULL));
        expect_shown(display, window, pixels);
        /* A window that is minimised. */
        OK(subsurf_surface_resize(surface, 0, 0));
        FAILS(UNSUPPORTED, "sides of windows", subsurf_surface_resize(surface, 0x7FFFFFFF, 1));
        OK(subsurf_surface_resize(surface, WIDTH, HEIGHT));
    }
    OK(subsurf_gpu_finish(stage->gpu));
    subsurf_surface_close(surface);
    destroy_window(display, window);
    sync_display(display, 0);
}

int main(int argc, char **argv) {
    static unsigned char pixels[WIDTH * HEIGHT * 4];
    Stage stage;
    SubsurfSurface *surface = NULL;
    void *display;
    long files = 0;
    uint64_t heap = 0, bytes = 0;
    EXPECT(argc == 4);
    open_xlib();
    display = open_display(NULL);
    EXPECT(display != NULL);
    memset(&stage, 0, sizeof stage);
    stage.gpu = open_gpu(strcmp(argv[2], "gl") == 0 ? SUBSURF_BACKEND_GL : SUBSURF_BACKEND_VULKAN, SUBSURF_WINDOW_SYSTEM_X11, display);
    load(&stage, argv[1], SUBSURF_TECHNIQUE_AUTOMATIC);
    OK(subsurf_renderer_create(stage.gpu, NULL, &stage.renderer));
    OK(subsurf_picture_create(stage.gpu, WIDTH, HEIGHT, &stage.picture));
    OK(subsurf_renderer_draw_picture(stage.renderer, &stage.frame, stage.picture, NULL));
    OK(subsurf_picture_read(stage.picture, pixels, sizeof pixels, 0));
    FAILS(INVALID_ARGUMENT, "window is null", subsurf_surface_open(stage.gpu, 0, 1, 1, &surface));
    FAILS(INVALID_ARGUMENT, "surface_out is null", subsurf_surface_open(stage.gpu, 1, 1, 1, NULL));
    cycle(&stage, display, pixels);
    for (int k = 0, count = atoi(argv[3]); k < count; k++) {
        cycle(&stage, display, NULL);
        if (k == count / 5) {
            heap = heap_bytes();
            files = open_files();
            bytes = bytes_on(stage.gpu);
        }
    }
    printf("%lu bytes of heap, then %lu\n", (unsigned long)heap, (unsigned long)heap_bytes());
    /* Mesa's OpenGL takes a quarter of a megabyte more now and then; surfaces that stay would be two megabytes. */
    EXPECT(heap_bytes() <= heap + 524288 && open_files() == files && bytes_on(stage.gpu) == bytes);
    close_stage(&stage);
    close_display(display);
    return 0;
}
