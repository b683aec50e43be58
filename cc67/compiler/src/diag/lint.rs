//! The warnings: one list, each with a code, a switch and a default.
//!
//! A row of `for_each_lint!` is a lint; its name is the `-W` switch. One that needs a search of its own names it as
//! its pass, a file of [`lints`](crate::lints).

/// The switch that enables a lint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// None: it names a defect, and seldom anything else.
    On,
    /// `-Wall`: it names what is often a mistake.
    All,
    /// `-Wextra`: it asks for more care than most programs need.
    Extra,
    /// Its own name, and the command line of the vendor's compiler.
    Own,
}

/// Hands every row of the lint table to the macro `$m`.
macro_rules! for_each_lint {
    ($m:ident) => {
        $m! {
            /// A function is called without the declaration that it needs.
            ImplicitDeclaration = "implicit-declaration", On;
            /// A function that takes and returns only integers and pointers is called before its definition.
            LateDefinition = "late-definition", Extra;
            /// Firmware 4.34 lacks a function, or the program defines a function that the firmware also has.
            Portability = "portability", Extra, pass portability;
            /// A declaration names no type in a place where `int` is seldom meant.
            ImplicitInt = "implicit-int", On;
            /// The types of the parameters come after the parentheses, as before 1989.
            OldStyleDefinition = "old-style-definition", On;
            /// `main` has parameters, which the board does not pass.
            MainParameters = "main-parameters", On;
            /// A macro is redefined with a different body.
            MacroRedefined = "macro-redefined", On;
            /// The text is not quite C, but the vendor's compiler accepts it.
            LaxText = "lax-text", On;
            /// A function, local variable or enumerator is declared twice, or a name that the firmware uses is redefined.
            Redeclared = "redeclared", On, pass firmware_name;
            /// A prototype differs from the definition.
            PrototypeMismatch = "prototype-mismatch", On;
            /// A call has more arguments than the definition takes.
            ExtraArguments = "extra-arguments", On;
            /// An integer and a pointer are mixed without a cast.
            IntPointer = "int-pointer", On;
            /// Pointers to types of different size or kind are mixed without a cast.
            PointerMismatch = "pointer-mismatch", On;
            /// A variable is passed where its address is needed: the `&` is missing.
            MissingAddress = "missing-address", On;
            /// An assignment is used as a condition.
            AssignmentCondition = "assignment-condition", On;
            /// An operator in a condition applies to less than it seems to.
            Precedence = "precedence", On;
            /// An operator takes a part of a macro or of its argument, because parentheses are missing.
            MacroParentheses = "macro-parentheses", On;
            /// `=-` or `=+` is written where `-=` or `+=` is probably meant.
            ReversedOperator = "reversed-operator", On;
            /// The name of a function is used where its result is meant: the `()` is missing.
            MissingCall = "missing-call", On, pass missing_call;
            /// A statement computes a value, or asks the board for one, and discards it.
            UnusedValue = "unused-value", On, pass unused_value;
            /// An `if` or a loop ends in a `;` that is probably not meant.
            EmptyBody = "empty-body", On;
            /// An `else` belongs to another `if` than its indentation suggests.
            DanglingElse = "dangling-else", On;
            /// A condition repeats an earlier one of the same `else if` chain.
            DuplicatedCondition = "duplicated-condition", On;
            /// A local variable that is only assigned has the name of a global one.
            Shadow = "shadow", On, pass shadow;
            /// A lock is a local variable, so that each thread has its own.
            LocalLock = "local-lock", On, pass local_lock;
            /// No `goto` names a label.
            UnusedLabel = "unused-label", On;
            /// The value of a void function is used.
            VoidValue = "void-value", On;
            /// A function may end without a value that a caller uses.
            MissingReturn = "missing-return", On, pass missing_return;
            /// A function may end without its value, and no caller uses it.
            FallsOffEnd = "falls-off-end", All;
            /// An integer constant has the suffix `f`.
            IntegerFloatSuffix = "integer-float-suffix", On;
            /// The result of a computation with integer constants does not fit in its type.
            Overflow = "overflow", On, pass overflow;
            /// A number begins with 0, which makes it octal.
            Octal = "octal", On;
            /// `^` between two numbers is exclusive or, not a power.
            Power = "power", On, pass power;
            /// A constant does not fit in the type that stores it.
            ConstantConversion = "constant-conversion", On;
            /// `sizeof` is applied to a pointer, where the size of an array is probably meant.
            SizeofPointer = "sizeof-pointer", On;
            /// A constant shift count is negative or not less than the width of the value.
            ShiftCount = "shift-count", On;
            /// A format conversion does not match its argument.
            Format = "format", On, pass format;
            /// A format conversion behaves differently on the board than in standard C.
            BoardFormat = "board-format", All, pass board_format;
            /// A file is opened whose name contains an escape, such as a tab.
            FileName = "file-name", On, pass file_name;
            /// A local variable is read before it is assigned.
            Uninitialized = "uninitialized", On, pass uninitialized;
            /// A local variable may be read before it is assigned.
            MaybeUninitialized = "maybe-uninitialized", All;
            /// A string is longer than the array it initialises.
            LongString = "long-string", On;
            /// A `const` object is modified.
            ConstWrite = "const-write", On;
            /// An array index is out of range.
            ArrayBounds = "array-bounds", On, pass array_bounds;
            /// `persist.UserData` is indexed outside 0..199.
            UserDataIndex = "user-data-index", On;
            /// A constant is outside the range of an output.
            ValueRange = "value-range", On, pass value_range;
            /// A `double` lies at an odd index of `persist.UserData`.
            UserDataAlignment = "user-data-alignment", On;
            /// A frame or a chain of calls needs more than the board's small stack.
            StackSize = "stack-size", On, pass stack_size;
            /// A function calls itself, so the stack that it needs is unknown.
            Recursion = "recursion", Extra, pass recursion;
            /// A floating-point value is compared with itself.
            SelfComparison = "self-comparison", On, pass self_comparison;
            /// An endless loop neither waits nor has an effect.
            IdleLoop = "idle-loop", On, pass idle_loop;
            /// A statement is indented as if it belonged to the condition above it.
            MisleadingIndentation = "misleading-indentation", On;
            /// A condition without braces guards only the first statement of a macro.
            MultistatementMacro = "multistatement-macro", On;
            /// A function that may wait is called in a call-back of the servo interrupt.
            CallBackWait = "call-back-wait", On, pass call_back_wait;
            /// A call-back of the servo interrupt takes more time than the servo leaves for it.
            SlowCallback = "slow-callback", On, pass slow_callback;
            /// A local copy of `KMotionDef.h` belongs to another version of the firmware.
            HeaderMismatch = "header-mismatch", On, pass header_mismatch;
            /// A local variable is never used.
            UnusedVariable = "unused-variable", All, pass unused_variable;
            /// `main` is declared `void`.
            VoidMain = "void-main", Extra, pass void_main;
            /// A number is converted to a type that may not be able to represent it.
            Conversion = "conversion", Extra;
            /// A fraction is lost: in an integer that stores a constant, in `persist.UserData`, or in the argument of `abs`.
            LostFraction = "lost-fraction", On, pass lost_fraction;
            /// A place of an axis is stored in a type that is too small for it.
            NarrowType = "narrow-type", On, pass narrow_type;
            /// A division of integers loses its fraction before it is used as a floating-point number.
            IntegerDivision = "integer-division", On, pass integer_division;
            /// An element of `persist.UserData` is used as a pointer where its address is meant: the `&` is missing.
            UserDataPointer = "user-data-pointer", On, pass user_data_pointer;
            /// A `case` of a `switch` continues into the next one: its `break` is missing.
            FallThrough = "fall-through", On, pass fall_through;
            /// Two addresses are compared where the texts at them are meant.
            TextComparison = "text-comparison", On, pass text_comparison;
            /// A function returns the address of a variable that ends with it.
            ReturnedLocal = "returned-local", On, pass returned_local;
            /// A function changes only its own copies of its arguments.
            ParameterCopy = "parameter-copy", On, pass parameter_copy;
            /// A structure is copied, and values are stored in the copy, which nothing reads.
            UnusedCopy = "unused-copy", On, pass unused_copy;
            /// A variable counts a loop of `main` from its initial value, and nothing sets it back when the program starts again.
            KeptCounter = "kept-counter", On, pass kept_counter;
            /// A mean is computed from a sum that was not set back to 0 since the last one.
            StaleSum = "stale-sum", On, pass stale_sum;
            /// `a = b; b = a;`: a swap that loses the first value.
            LostSwap = "lost-swap", On, pass lost_swap;
            /// The position of an axis without an input is read.
            StalePosition = "stale-position", On, pass stale_position;
            /// A text is stored in an array that is too small for it.
            TextOverflow = "text-overflow", On, pass text_overflow;
            /// One side of `&&` or `||` is a number other than 0 and 1.
            LogicalConstant = "logical-constant", On;
            /// The answer of a message box is compared with a number that none of its buttons has.
            BoxAnswer = "box-answer", On, pass box_answer;
            /// A loop that waits for several axes ends with the first one.
            WaitForAny = "wait-for-any", On, pass wait_for_any;
            /// A line among the settings of one axis sets another: it was copied from there.
            CopiedAxis = "copied-axis", On, pass copied_axis;
            /// The type of a value decides a comparison.
            ConstantComparison = "constant-comparison", On, pass constant_comparison;
            /// A variable that can be negative is compared with an unsigned value.
            NegativeComparison = "negative-comparison", On, pass negative_comparison;
            /// A loop never begins, or counts away from its end.
            LoopCondition = "loop-condition", On, pass loop_condition;
            /// A statement comes after a jump or an endless loop, so it is never executed.
            UnreachableCode = "unreachable-code", On, pass unreachable_code;
            /// A variable is changed twice in an expression, in no order.
            Unsequenced = "unsequenced", On, pass unsequenced;
            /// An angle is given in degrees where radians are needed.
            Degrees = "degrees", On, pass degrees;
            /// A time is given in milliseconds where seconds are needed.
            Milliseconds = "milliseconds", On, pass milliseconds;
            /// A loop or a call waits until a time since power-up that has passed already.
            AbsoluteTime = "absolute-time", On, pass absolute_time;
            /// An analog input, which is read in counts, is compared with a number of volts.
            AdcCounts = "adc-counts", On, pass adc_counts;
            /// An analog output, which is written in counts, is given a number of volts.
            DacCounts = "dac-counts", On;
            /// A recording is read as soon as it has begun.
            GatherEarly = "gather-early", On, pass gather_early;
            /// An answer of the PC or a result of another thread is read before it can be there.
            EarlyAnswer = "early-answer", On, pass early_answer;
            /// A `float` or an `int` holds the time since power-up.
            FloatTime = "float-time", On, pass float_time;
            /// A `float` counts further than its digits reach.
            FloatCounter = "float-counter", On, pass float_counter;
            /// Rounded floating-point numbers are compared for equality.
            FloatEquality = "float-equality", On, pass float_equality;
            /// An element of `persist.UserData` is stored as one type and read as another.
            UserDataType = "user-data-type", On, pass user_data_type;
            /// A loop waits for a variable that nothing in the program changes.
            EndlessWait = "endless-wait", On, pass endless_wait;
            /// A signed and an unsigned value are compared.
            SignCompare = "sign-compare", Extra;
            /// Memory that another thread or the call-back shares is changed in a way that can be interrupted.
            Races = "races", On;
            /// The vendor's compiler accepts the construct and generates wrong code for it.
            Vendor = "vendor", Own, pass vendor;
            /// The vendor's compiler uses a wrong address for a parameter, or cannot pass it.
            VendorParameter = "vendor-parameter", On, pass vendor_parameter;
            /// Standard C does not allow the construct, but the vendor's compiler accepts it.
            Extension = "extension", On;
        }
    };
}

macro_rules! define_lints {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal, $preset:ident $(, pass $pass:ident)?;)*) => {
        /// A warning that a switch controls.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Lint {
            $($(#[doc = $doc])+ $variant,)*
        }

        impl Lint {
            /// Every lint in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The name of its switch, without `-W`: what messages show and `--explain` takes.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// A description of the lint in one sentence.
            #[must_use]
            pub const fn summary(self) -> &'static str {
                match self {
                    $(Self::$variant => concat!($($doc),+).trim_ascii_start(),)*
                }
            }

            /// The switch that it waits for.
            #[must_use]
            pub const fn preset(self) -> Preset {
                match self {
                    $(Self::$variant => Preset::$preset,)*
                }
            }

            /// Its page in Markdown: why it matters, programs that fire it, their repair.
            #[must_use]
            pub const fn page(self) -> &'static str {
                match self {
                    $(Self::$variant => include_str!(concat!("../lints/pages/", $name, ".md")),)*
                }
            }
        }
    };
}
for_each_lint!(define_lints);
pub(crate) use for_each_lint;

impl Lint {
    /// The switches for it, as the end of its page.
    #[must_use]
    pub fn switches(self) -> String {
        let name = self.name();
        let default = match self.preset() {
            Preset::On => "on",
            Preset::All => "off; also switched on by `-Wall`",
            Preset::Extra => "off; also switched on by `-Wextra`",
            Preset::Own => "off; on when cc67 is called as `tcc67`",
        };
        format!(
            "## Switches\n\n`-W{name}` on, `-Wno-{name}` off, `-Werror={name}` on and an error. Default: {default}.\n"
        )
    }
}
