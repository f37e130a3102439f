/* Reports on texture files, and on the Vulkan devices of this machine. */
#include "show.h"

#include "file_report.h"
#include "neural_file.h"

#include "../common/text.h"

#include <stdio.h>

static int show_files(const struct options *options)
{
    int status = ALL_SHOWN;
    for (size_t i = 0; i < options->files.count; i++)
        if (!report_file(options->files.items[i], options->json, stdout))
            status = NOT_SHOWN;
    return status;
}

static int decode(const struct options *options)
{
#ifdef HAVE_NEURAL
    return decode_neural_file(options);
#else
    (void)options;
    text_say("sluice-info: this build reads no neural textures");
    return NOT_SHOWN;
#endif
}

int main(int argc, char **argv)
{
    struct options options;
    int status = ALL_SHOWN;
    enum option_outcome outcome = parse_options(&options, argc, argv);
    if (outcome == OPTIONS_ERROR)
        return WRONG_USAGE;
    if (outcome == OPTIONS_HELP)
        status = ALL_SHOWN;
    else if (options.decode >= 0)
        status = decode(&options);
    else if (options.png)
        status = write_picture(&options);
    else if (options.files.count)
        status = show_files(&options);
    else if (options.self_test)
        status = self_test(&options);
    else
        status = show_devices(&options);
    return text_flush("sluice-info: ") ? status : NOT_SHOWN;
}
