/* Sweeps the settings of a scene and shows the cost of each: see --help and docs/trade-offs.md. */
#include "commands.h"
#include "play.h"

#include "../common/text.h"

#include <stddef.h>
#include <string.h>

static const struct command {
    const char *name;
    int (*run)(int argc, char **argv);
} commands[] = {
    {"sweep", command_sweep},
    {"page", command_page},
    {"play", play_main},
};

static int run(int argc, char **argv)
{
    for (size_t i = 0; argc > 1 && i < sizeof commands / sizeof *commands; i++)
        if (strcmp(argv[1], commands[i].name) == 0) {
            argv[1] = argv[0];
            return commands[i].run(argc - 1, argv + 1);
        }
    return command_sweep(argc, argv);
}

int main(int argc, char **argv)
{
    int status = run(argc, argv);
    return text_flush("sluice-tradeoff: ") || status != TRADEOFF_DONE ? status : TRADEOFF_FAILED;
}
