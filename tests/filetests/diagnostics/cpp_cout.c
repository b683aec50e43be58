//@ exit: 1
//@ snapshot
#include <iostream>
#include "KMotionDef.h"

using namespace std;

main()
{
    cout << "position " << ch0->Position << endl;
}
