/*
 * Runs device tests (tests/device) on the user's driver and reports each. Every group runs in a
 * process of its own: a driver that crashes or hangs fails one group only. This process never loads
 * a driver, because forking would not be safe then.
 */
#define _XOPEN_SOURCE 700

#include "show.h"

#include "devices.h"
#include "report.h"
#include "self_test_checks.h"
#include "../common/clock.h"
#include "../common/output_file.h"
#include "../common/text.h"

#include <sluice/version.h>

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define GROUP_SECONDS 240u ///< time limit; a slower group fails
#define NO_DEVICE 100      ///< exit status of the process that looks for devices
#define LINE 2048
#define TEXT_OF(number) #number
#define VERSION(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)
#define VERSION_TEXT VERSION(SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR, SLUICE_VERSION_PATCH)

/* Main functions of the tests, renamed by the build. */
int self_test_conformance(void);
int self_test_conformance_sampler(void);
int self_test_residency(void);
int self_test_fades(void);
int self_test_formats(void);
int self_test_extremes(void);

struct group {
    const char *name;
    int (*run)(void);
    uint32_t mode_count; ///< number of leading `modes` to run; 0: independent of the mode
};

static const struct group groups[] = {
    {"conformance", self_test_conformance, 0}, {"sampler", self_test_conformance_sampler, 0},
    {"residency", self_test_residency, 3},     {"fades", self_test_fades, 3},
    {"formats", self_test_formats, 2},         {"extremes", self_test_extremes, 3},
};
#define GROUPS (sizeof groups / sizeof groups[0])

static const char *const modes[] = {"sparse", "paged", "dense"};

struct run {
    const struct options *options;
    const struct group *group;
    const char *mode, *device;
    FILE *file; ///< file of --report, or NULL
    FILE *log;  ///< output of the group
    char current[256];
    char validation[8]; ///< "on" or "off", as printed by the groups; empty before the first one
    uint32_t passed, failed, skipped;
};

static void print_check(FILE *out, const struct run *run, const char *name, const char *result,
                        double seconds, const char *reason)
{
    fprintf(out, "  %s  %-11s %-6s  %s  (%.1f s)\n", result, run->group->name, run->mode, name,
            seconds);
    if (*reason) {
        fprintf(out, "        ");
        text_write(out, reason);
        fprintf(out, "\n");
    }
}

static void report(struct run *run, const char *name, const char *result, double seconds,
                   const char *reason)
{
    uint32_t *count = strcmp(result, "pass") == 0   ? &run->passed
                      : strcmp(result, "skip") == 0 ? &run->skipped
                                                    : &run->failed;
    ++*count;
    if (run->options->json) {
        printf("{\"check\":");
        text_write_json(stdout, name);
        printf(",\"group\":\"%s\",\"mode\":\"%s\",\"result\":\"%s\",\"seconds\":%.3f,\"reason\":",
               run->group->name, run->mode, result, seconds);
        text_write_json(stdout, reason);
        printf("}\n");
    } else {
        print_check(stdout, run, name, result, seconds, reason);
    }
    if (run->file) {
        print_check(run->file, run, name, result, seconds, reason);
        fflush(run->file); /* otherwise a child would write it again */
    }
    fflush(stdout);
}

/* Copies the last line of the group's output that contains `words`, from there on; empty if
 * none. */
static void find_line(FILE *log, const char *words, char *line, size_t size)
{
    char text[LINE];
    line[0] = '\0';
    rewind(log);
    while (fgets(text, sizeof text, log)) {
        const char *found = strstr(text, words);
        if (!found)
            continue;
        snprintf(line, size, "%s", found + strlen(words));
        line[strcspn(line, "\n")] = '\0';
    }
}

static void take_line(struct run *run, char *line)
{
    char none[1] = "", *fields[5] = {line, none, none, none, none};
    line[strcspn(line, "\n")] = '\0';
    for (int i = 1; i < 5; i++) {
        char *tab = strchr(fields[i - 1], '\t');
        if (!tab)
            break;
        *tab = '\0';
        fields[i] = tab + 1;
    }
    snprintf(run->current, sizeof run->current, "%s",
             strcmp(fields[0], "begin") == 0 ? fields[1] : "");
    if (strcmp(fields[0], "end") == 0)
        report(run, fields[1], fields[2], strtod(fields[3], NULL), fields[4]);
}

/* Reports how the process of a group ended, if its checks do not tell. */
static void take_end(struct run *run, int status, uint32_t failed_before)
{
    char reason[LINE] = "";
    const char *name = run->current[0] ? run->current : "all checks";
    if (WIFSIGNALED(status)) {
        int number = WTERMSIG(status);
        snprintf(reason, sizeof reason, number == SIGALRM ? "took longer than %u s" : "signal %u",
                 number == SIGALRM ? GROUP_SECONDS : (unsigned)number);
        report(run, name, "fail", 0, reason);
    } else if (WEXITSTATUS(status) == 77) {
        find_line(run->log, "# SKIP ", reason, sizeof reason);
        report(run, name, "skip", 0, reason);
    } else if (WEXITSTATUS(status) != 0 && run->failed == failed_before) {
        find_line(run->log, "# validation: ", reason, sizeof reason);
        report(run, name, "fail", 0, *reason ? reason : "ended with an error");
    }
}

_Noreturn static void run_here(const struct run *run, int pipe_end)
{
    FILE *out = fdopen(pipe_end, "w");
    if (!out || dup2(fileno(run->log), STDOUT_FILENO) < 0 ||
        dup2(fileno(run->log), STDERR_FILENO) < 0)
        _exit(1);
    setvbuf(stdout, NULL, _IONBF, 0);
    setenv("SLUICE_DEVICE", run->device, 1);
    setenv("SLUICE_RESIDENCY", run->mode, 1);
    unsetenv("SLUICE_ABANDON");
    self_test_report_to(out);
    alarm(GROUP_SECONDS);
    int status = run->group->run();
    fflush(out);
    _exit(status);
}

static bool run_group(struct run *run)
{
    int ends[2], status = 0;
    char line[LINE];
    uint32_t failed_before = run->failed;
    if (!(run->log = tmpfile()) || pipe(ends) != 0)
        return false;
    pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        run_here(run, ends[1]);
    }
    close(ends[1]);
    FILE *in = fdopen(ends[0], "r");
    run->current[0] = '\0';
    while (in && fgets(line, sizeof line, in))
        take_line(run, line);
    if (in)
        fclose(in);
    bool ran = child > 0 && waitpid(child, &status, 0) == child;
    if (ran)
        take_end(run, status, failed_before);
    if (!run->validation[0])
        find_line(run->log, ", validation ", run->validation, sizeof run->validation);
    fclose(run->log);
    return ran;
}

/* Prints the device in a process of its own, and returns its index. `file`: see struct run. */
static int show_device(const struct options *options, FILE *file)
{
    static struct device_report report;
    struct devices devices;
    if (!open_devices(&devices))
        return NO_DEVICE;
    for (uint32_t i = 0; i < devices.count; i++) {
        char number[16];
        snprintf(number, sizeof number, "%u", i);
        if (!ask_device(&devices, i, options->image[0], options->image[1], &report))
            continue;
        bool wanted = options->device ? strcmp(options->device, number) == 0 ||
                                            strstr(report.capabilities.deviceName, options->device)
                                      : !report.missing_for[FORMAT_MODE_PAGED][0];
        if (!wanted)
            continue;
        if (options->json)
            print_json(&report);
        else
            print_limits(stdout, &report);
        if (file)
            print_limits(file, &report);
        if (file && fflush(file) != 0)
            return NO_DEVICE;
        return text_flush("sluice-info: ") ? (int)i : NO_DEVICE;
    }
    text_say("sluice-info: no device to test; --list-devices names those there are");
    return NO_DEVICE;
}

static int choose_device(const struct options *options, FILE *file)
{
    int status = 0;
    fflush(stdout);
    if (file)
        fflush(file);
    pid_t child = fork();
    if (child == 0) {
        int index = show_device(options, file);
        fflush(stdout);
        _exit(index);
    }
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
        text_say("sluice-info: the driver does not start");
        return NO_DEVICE;
    }
    if (file) /* the child has written */
        fseek(file, 0, SEEK_END);
    return WEXITSTATUS(status);
}

/* Prints version, date, system and groups. The device follows. */
static void print_head(FILE *out, const struct options *options)
{
    struct utsname system = {0};
    char date[16] = "";
    time_t now = time(NULL);
    const struct tm *utc = gmtime(&now);
    if (utc)
        strftime(date, sizeof date, "%Y-%m-%d", utc);
    uname(&system);
    fprintf(out, "Self-test of Sluice " VERSION_TEXT "\n");
    fprintf(out, "  date                    %s\n", date);
    fprintf(out, "  system                  %s %s, %s\n", system.sysname, system.release,
            system.machine);
    fprintf(out, "  groups                  %s\n", options->group ? options->group : "all");
}

static void print_sum(FILE *out, const struct run *run, double seconds, double processor)
{
    fprintf(out,
            "%u passed, %u failed, %u skipped in %.0f s; processor time %.0f s; validation %s\n",
            run->passed, run->failed, run->skipped, seconds, processor,
            run->validation[0] ? run->validation : "unknown");
}

/* Processor time of all groups' processes in s. */
static double processor_seconds(void)
{
    struct rusage usage = {0};
    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)usage.ru_utime.tv_sec + (double)usage.ru_stime.tv_sec +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static bool is_chosen(const struct options *options, const struct group *group)
{
    return !options->group || strcmp(options->group, group->name) == 0;
}

static bool run_all(struct run *run)
{
    for (size_t g = 0; g < GROUPS; g++) {
        run->group = &groups[g];
        uint32_t count = groups[g].mode_count;
        for (uint32_t m = 0; (m == 0 || m < count) && is_chosen(run->options, run->group); m++) {
            run->mode = count ? modes[m] : "auto";
            fprintf(stderr, "sluice-info: %zu of %zu: %s, %s\n", g + 1, GROUPS, run->group->name,
                    run->mode);
            if (!run_group(run)) {
                text_say("sluice-info: cannot start a process");
                return false;
            }
        }
    }
    return true;
}

/* Returns false if a process could not start, or if there is no device to test. */
static bool run_on_device(struct run *run)
{
    char device[16];
    double start = clock_seconds();
    int index = choose_device(run->options, run->file);
    if (index >= NO_DEVICE)
        return false;
    snprintf(device, sizeof device, "%d", index);
    run->device = device;
    bool ran = run_all(run);
    double seconds = clock_seconds() - start, processor = processor_seconds();
    if (run->options->json)
        printf("{\"version\":\"" VERSION_TEXT "\",\"passed\":%u,\"failed\":%u,\"skipped\":%u,"
               "\"seconds\":%.1f,\"processorSeconds\":%.1f}\n",
               run->passed, run->failed, run->skipped, seconds, processor);
    else
        print_sum(stdout, run, seconds, processor);
    if (run->file)
        print_sum(run->file, run, seconds, processor);
    return ran;
}

int self_test(const struct options *options)
{
    struct run run = {.options = options};
    struct output_file *file = NULL;
    output_set_speaker("sluice-info: ");
    if (options->report && !(file = output_file_begin(options->report)))
        return NOT_SHOWN;
    run.file = file ? output_file_stream(file) : NULL;
    if (!options->json)
        printf("Self-test of Sluice " VERSION_TEXT "\n");
    if (run.file)
        print_head(run.file, options);
    bool ran = run_on_device(&run);
    if (file && !output_file_end(file, ran))
        return NOT_SHOWN;
    return ran && run.failed == 0 && run.passed > 0 ? ALL_SHOWN : NOT_SHOWN;
}
