// jog_panel.h - the bits of the panel that jog_bits.c listens to.

#define BUTTON_PLUS  1024
#define BUTTON_MINUS 1025
#define BUTTON_FAST  1026
#define PANEL_END    1031       // the operator has finished
