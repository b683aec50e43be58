//! The firmware functions that may wait, and what for.
//!
//! While a function waits, other threads run; the call-back of the servo interrupt must not call one. A function that
//! is not here returns in the time that its row states.

/// Names and what is waited for, by name.
pub const WAITING: &[(&str, &str)] = &[
    ("Delay_sec", "until the time has passed"),
    ("EnableRS232Cmds", "about 2 ms for the UART"),
    ("InitRS232", "about 2 ms for the UART"),
    ("MutexLock", "while another thread holds the lock"),
    ("Print", "while the console queue is full"),
    ("PrintFloat", "while the console queue is full"),
    ("PrintInt", "while the console queue is full"),
    ("ProgramFlash", "until the flash is written"),
    ("ProgramFlashNoMessages", "until the flash is written"),
    ("RS232_GetChar", "while no character has been received"),
    ("RS232_PutChar", "while the transmit ring is full"),
    ("WaitNextTimeSlice", "until the next slice of the thread"),
    ("WaitUntil", "until that time"),
    ("fclose", "while the console queue is full"),
    ("fgets", "until the PC has sent the line"),
    ("fopen", "until the PC has opened the file, if it is for reading"),
    ("fprintf", "while the console queue is full"),
    ("fscanf", "until the PC has sent the line"),
    ("printf", "while the console queue is full"),
    ("putchar", "while the console queue is full"),
    ("puts", "while the console queue is full"),
    ("vprintf", "while the console queue is full"),
];

/// What a function waits for, if it may wait.
#[must_use]
pub fn waits_for(function: &str) -> Option<&'static str> {
    WAITING.iter().find(|(name, _)| *name == function).map(|(_, what)| *what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::function_named;

    #[test]
    fn rows_name_existing_functions_in_order() {
        assert!(WAITING.is_sorted_by(|a, b| a.0 < b.0));
        for (name, _) in WAITING {
            assert!(function_named(name).is_some(), "{name}");
        }
    }

    #[test]
    fn functions_whose_row_says_that_they_wait_are_listed() {
        for row in crate::firmware::FIRMWARE_FUNCTIONS {
            let says = row.doc.contains("Waits") || row.doc.contains("waits");
            assert!(!says || waits_for(row.name).is_some(), "{}", row.name);
        }
    }
}
