//! The plain numbers of the board that Rust code needs; the headers have the rest.

use crate::ids::Axes;

macro_rules! limits {
    ($($(#[$doc:meta])+ $name:ident: $ty:ty = $value:literal;)*) => {
        $($(#[$doc])+ pub const $name: $ty = $value;)*

/// The answer of the firmware to `Version`, with its line end.
pub const VERSION: &str = "KFLOP 4.34 Build 16:07:06 Aug 14 2018\n";
/// The version stamp of images that are linked against firmware 4.34: the linker writes it, the loader compares it.
pub const VERSION_STAMP: i16 = 434;

#[cfg(test)]
        const ALL: &[(&str, f64)] = &[$((stringify!($name), $value as f64)),*];
    };
}

limits! {
    /// Servo sample period in seconds.
    TIMEBASE: f64 = 0.00009;
    /// Counting rate of TIMER0 in hertz.
    CLOCKFREQ: f64 = 50.0e6;

    /// Axes.
    N_CHANNELS: usize = 8;
    /// User threads.
    N_USER_THREADS: usize = 7;
    /// Filters of an axis.
    N_IIR_FILTERS: usize = 3;
    /// Elements of `persist.UserData`.
    N_USER_DATA_VARS: usize = 200;
    /// Index of the PC request in `persist.UserData`.
    PC_COMM_PERSIST: usize = 100;
    /// Elements from there on that a status record carries.
    N_PC_COMM_PERSIST: usize = 8;

    /// States in the coefficient list of an axis.
    MAX_TRIP: usize = 20;
    /// Entries of the coordinated-motion buffer.
    MAX_SEGMENTS: usize = 35000;
    /// Entries of `gather.list`.
    MAX_GATHER_VALUES: usize = 32;
    /// Doubles in the gather buffer.
    MAX_GATHER_DATA: usize = 1000000;
    /// Floats in the Bode work buffer.
    N_CPLX: usize = 2048;

    /// Bytes of a console string.
    MAX_STRING: usize = 128;
    /// Strings in the console queue.
    MAX_NSTRINGS: usize = 256;
    /// Bytes of a line read from a file on the PC.
    MAX_READ_DISK_LENGTH: usize = 1024;
    /// Bytes in each ring of the UART.
    RS232BUFSZ: usize = 1000;
    /// Bytes in a line of a program download.
    N_BYTES_PER_LINE: usize = 64;

    /// Analog inputs.
    N_ADCS: usize = 8;
    /// Analog outputs.
    N_DACS: usize = 8;
    /// Encoder inputs on board.
    N_ENCS: usize = 8;
    /// Step generators.
    NSTEPDIR: usize = 8;
    /// PWM channels on board.
    N_PWMS: usize = 8;
    /// PWM channels of a SnapAmp.
    N_PWMS_SNAP: usize = 4;
    /// PWM generators for I/O bits.
    N_IO_PWMS: usize = 8;

    /// Limit of `WritePWM`.
    MAX_PWM_VALUE: i32 = 230;
    /// Limit of `WritePWMR`.
    MAX_PWMR_VALUE: i32 = 400;
    /// Limit of `WritePWMC`.
    MAX_PWMC_VALUE: i32 = 1000;
    /// Largest vector of `Write3PH`.
    MAXV: f32 = 230.0;

    /// Length of a step pulse in clocks of 16.67 MHz at power-up.
    STEP_PULSE_LENGTH_DEFAULT: u8 = 32;
    /// Length of the encoder noise filter at power-up.
    ENC_NOISE_FILTER_DEFAULT_VAL: u8 = 7;
    /// Bytes that a flash erase covers.
    FLASH_BLOCK_SIZE: u32 = 0x10000;
}

/// The axes of the default board.
impl Default for Axes {
    fn default() -> Self {
        Self::new(N_CHANNELS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::table;

    #[test]
    fn numbers_agree_with_the_specification() {
        let specified = table("constants.csv");
        for (name, value) in ALL {
            let row = specified.iter().find(|row| row["name"] == *name).expect(name);
            assert_eq!(row["value"].parse(), Ok(*value), "{name}");
        }
    }
}
