#include "viewer.h"

void viewer_follow_trade(struct viewer *v)
{
    struct view_app *app = &v->app;
    const struct trade_request request = {.settings = &app->settings,
                                          .path = app->path.count > 0 ? &app->path
                                                  : v->stage ? app_path(&v->app, FOLLOW_CAMERA)
                                                             : NULL,
                                          .camera = &app->camera,
                                          .paths = &v->paths,
                                          .cache = v->options->cache,
                                          .device = v->options->device,
                                          .threads = app->settings.threads};
    if (app->trade_toggle && v->trade.state == TRADE_RUNS)
        trade_cancel(&v->trade);
    else if (app->trade_toggle && v->stage)
        trade_begin(&v->trade, &request);
    if (app->trade_page)
        trade_open_page();
    app->trade_toggle = app->trade_page = false;
    trade_watch(&v->trade);
}
